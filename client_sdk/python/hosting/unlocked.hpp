#pragma once

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <atomic>

namespace cohort::python {

/// Releases Python's global lock during its lifetime, for long work in C++. Python can end meanwhile, if the thread is
/// a daemon: then the work must end too, and the thread waits forever instead of taking the lock, which no longer
/// exists.
class Unlocked {
 public:
  /// `stop`: set to true if the work must end; null: none.
  explicit Unlocked(std::atomic<bool>* stop = nullptr);
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked();

  /// Returns true if the work of the calling thread must end because Python ends.
  static bool must_end();

 private:
  std::atomic<bool>* stop_;
  PyThreadState* state_;
};

/// Ends the work without the lock before Python ends. To be called once, when a module is imported.
void watch_for_the_end_of_python();

}  // namespace cohort::python
