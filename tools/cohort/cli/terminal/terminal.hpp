#pragma once

#include <chrono>
#include <string>

#include "server/run/run.hpp"
#include "tools/cohort/cli/log.hpp"

namespace cohort::tool {

/// What people see of a run: progress, events and an end by error on the log, now and then where it cannot rewrite a
/// line; the summary on standard output.
class Terminal {
 public:
  struct Options {
    bool quiet = false;            ///< no summary
    bool own_controllers = false;  ///< their deaths are told by who started them
  };
  Terminal(Log& log, Options options) : log_(log), options_(options) {}

  void progress(const session::Progress& progress);
  void event(const session::RunEvent& event);
  void summary(const description::Experiment& experiment, const session::RunResult& result, double cpu_seconds);

 private:
  LogLevel level_of(const session::RunEvent& event);

  Log& log_;
  Options options_;
  std::string last_awaited_;
  bool was_paused_ = false;
  std::chrono::steady_clock::time_point last_line_;
  bool miss_was_told_ = false;
};

}  // namespace cohort::tool
