// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>
#include <utility>

#include "client_sdk/python/hosting/unlocked.hpp"

namespace cohort::python {

/// Detects Ctrl-C, and the end of Python, while C++ runs without Python's global interpreter lock. Not thread-safe.
class Interruption {
 public:
  /// Returns true if the work must end. It is cheap, because it checks only occasionally. Python's signal handlers run
  /// inside this call, on the calling thread.
  bool is_wanted() {
    const auto now = std::chrono::steady_clock::now();
    if (error_ || now - looked_ < std::chrono::milliseconds(50)) return error_.has_value();
    looked_ = now;
    if (Unlocked::must_end()) return true;
    const nanobind::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) error_.emplace();
    return error_.has_value();
  }
  /// Throws the exception of a handler, if there is one. Requires Python's global interpreter lock.
  void rethrow() {
    if (error_) throw *std::exchange(error_, std::nullopt);
  }

 private:
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  std::optional<nanobind::python_error> error_;
};

}  // namespace cohort::python
