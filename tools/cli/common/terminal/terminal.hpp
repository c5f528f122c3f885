// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <set>
#include <string>

#include "server/run/run.hpp"
#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// Console output of a run. Progress, events and a final error go to the log; progress is less frequent where lines
/// cannot be rewritten. The summary goes to standard output.
class Terminal {
 public:
  struct Options {
    bool quiet = false;            ///< no summary
    bool shows_progress = true;    ///< false: events only
    bool own_controllers = false;  ///< the starting process reports their deaths
  };
  Terminal(Log& log, Options options) : log_(log), options_(options) {}

  void progress(const session::Progress& progress);
  void event(const session::RunEvent& event);
  /// Writes the summary to standard output or standard error; to the latter only if messages are text.
  void summary(const description::Experiment& experiment, const session::RunResult& result, double cpu_seconds,
               std::FILE* stream);

 private:
  LogLevel level_of(const session::RunEvent& event);

  Log& log_;
  Options options_;
  std::string last_awaited_;
  bool was_paused_ = false;
  bool was_unrecorded_ = false;
  std::chrono::steady_clock::time_point last_line_;
  bool miss_was_told_ = false;
  std::set<std::string> unsaved_told_;  // texts
};

}  // namespace cohort::tool
