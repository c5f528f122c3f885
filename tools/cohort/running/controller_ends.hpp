#pragma once

#include <pthread.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tools/cohort/cli/log.hpp"

namespace cohort::tool {

/// Names the controller that ends this process, by `exit` or `quick_exit`, or that crashes it. At most one at a time.
class ControllerEnds {
 public:
  struct Options {
    int exit_code = 1;     ///< of the process, if a controller ends it
    bool crashes = false;  ///< name those that crash too; the process still ends by the signal
  };

  /// `log` must outlive this. On the thread that calls controllers, if it names crashes.
  ControllerEnds(Log& log, const Options& options);
  ControllerEnds(const ControllerEnds&) = delete;
  ControllerEnds& operator=(const ControllerEnds&) = delete;
  ~ControllerEnds();

  /// Ends the run, with a sentence that says why, in place of a message. Returns the exit code. Called where a
  /// controller that this thread calls ends the process.
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
