#pragma once

#include <chrono>
#include <string>

#include "server/session/run.hpp"

namespace cohort::tool {

/// What people see of a run: one line of progress on standard error, rewritten in place on a terminal and now and then
/// elsewhere; events through the log; the summary on standard output.
class Terminal {
 public:
  explicit Terminal(bool quiet);
  ~Terminal();

  void progress(const session::Progress& progress);
  void event(const session::Event& event);
  /// A line of its own, above the progress.
  void say(const std::string& line);
  void summary(const session::RunResult& result, double cpu_seconds);

 private:
  void clear_line();

  bool quiet_;
  bool in_place_;
  bool line_open_ = false;
  std::string last_awaited_;
  std::chrono::steady_clock::time_point last_line_;
};

}  // namespace cohort::tool
