// SPDX-License-Identifier: Apache-2.0
#pragma once

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <atomic>

namespace cohort::python {

/// Releases Python's global interpreter lock (GIL) during its lifetime, for long work in C++. If the thread is a
/// daemon, Python can exit meanwhile: the work must then end too, and the destructor blocks forever, because the GIL no
/// longer exists.
class Unlocked {
 public:
  /// `stop`, which may be null, is set to true when the work must end.
  explicit Unlocked(std::atomic<bool>* stop = nullptr);
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked();

  /// Returns true if the work of the calling thread must end because Python exits.
  static bool must_end();

 private:
  std::atomic<bool>* stop_;
  PyThreadState* state_;
};

/// Registers an exit handler that ends all work without the GIL before Python exits. Call this once, when a module is
/// imported.
void watch_for_the_end_of_python();

}  // namespace cohort::python
