// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// Names the controller that crashes this process, or ends it by `exit` or `quick_exit`. At most one exists at a time.
class ControllerEnds {
 public:
  struct Options {
    int exit_code = 1;     ///< exit code of the process if a controller ends it
    bool crashes = false;  ///< also name controllers that crash; the process still ends by the signal
  };

  /// `log` must outlive this. If crashes are named, construct this on the thread that calls controllers.
  ControllerEnds(Log& log, const Options& options);
  ControllerEnds(const ControllerEnds&) = delete;
  ControllerEnds& operator=(const ControllerEnds&) = delete;
  ~ControllerEnds();

  /// Sets a function that ends the run, instead of a message, when a controller called by this thread ends the process.
  /// It takes the reason as a sentence and returns the exit code.
  void finish_with(std::function<int(const std::string& why)> finish) { finish_ = std::move(finish); }

 private:
  struct CrashHandlers;
  static void at_exit();
  [[noreturn]] void end_process();

  Log& log_;
  Options options_;
  std::function<int(const std::string&)> finish_;
  std::unique_ptr<CrashHandlers> crashes_;
};

}  // namespace cohort::tool
