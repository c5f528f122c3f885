#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>
#include <utility>

namespace cohort::python {

/// Notices Ctrl-C while C++ works without Python's global lock. One thread.
class Interruption {
 public:
  /// Returns whether the work is to end. Looks now and then only, so it may be asked often. Python's handlers run
  /// within it, on the thread that asks.
  bool is_wanted() {
    const auto now = std::chrono::steady_clock::now();
    if (error_ || now - looked_ < std::chrono::milliseconds(50)) return error_.has_value();
    looked_ = now;
    const nanobind::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) error_.emplace();
    return error_.has_value();
  }
  /// Throws what a handler has raised, if one has. Needs Python's global lock.
  void rethrow() {
    if (error_) throw *std::exchange(error_, std::nullopt);
  }

 private:
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  std::optional<nanobind::python_error> error_;
};

}  // namespace cohort::python
