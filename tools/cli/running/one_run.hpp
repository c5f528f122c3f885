// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "server/recording/recorder.hpp"
#include "server/run/run.hpp"
#include "tools/cli/common/terminal/printed_table.hpp"
#include "tools/cli/common/terminal/terminal.hpp"
#include "tools/cli/running/run_options.hpp"
#include "tools/cli/running/watchdog.hpp"
#include "tools/common/drawing/plot_view.hpp"
#include "tools/common/drawing/run_trace.hpp"

namespace cohort::tool {

/// One run of an experiment, with all its output.
class OneRun {
 public:
  /// `stop`: whether the process was asked to end. `command`, `log` and `stop` must outlive this.
  OneRun(const RunCommand& command, Outputs outputs, Log& log, const std::atomic<bool>& stop);

  /// Call this before the run, and again if another world replaces the previous one: then only the recording continues.
  /// Experiment and simulation must live until the next call, or until this is destroyed.
  void begin(const description::Experiment& experiment, const Simulation& simulation, recording::Beginning beginning);

  /// Returns the listener of the run that has begun.
  session::RunListener listener();

  /// Prints and writes the requested outputs, and closes the recording. Returns the exit code.
  int finish(session::RunResult result, double cpu_seconds);

 private:
  bool write_files(const session::RunResult& result, double cpu_seconds);
  bool close_recording(session::RunResult& result);

  const RunCommand& command_;
  Outputs outputs_;
  Log& log_;
  const std::atomic<bool>& stop_;
  const bool is_of_several_ = command_.is_part || !command_.seeds.empty();  // the results are in a table
  const description::Experiment* experiment_ = nullptr;
  const Simulation* simulation_ = nullptr;
  StageTimes stage_times_;            // empty unless `command_.profile`
  std::optional<Watchdog> watchdog_;  // while it runs
  std::optional<Terminal> terminal_;
  std::optional<TraceRecorder> trace_;
  std::optional<PrintedTable> table_;
  std::optional<recording::Recorder> recorder_;
  std::vector<recording::Recorder*> recorders_;  // `recorder_`, or empty
};

}  // namespace cohort::tool
