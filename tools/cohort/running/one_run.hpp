#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "server/recording/recorder.hpp"
#include "server/run/run.hpp"
#include "tools/cohort/cli/terminal/printed_table.hpp"
#include "tools/cohort/cli/terminal/terminal.hpp"
#include "tools/cohort/running/run_options.hpp"
#include "tools/cohort/running/watchdog.hpp"
#include "tools/drawing/plot_view.hpp"
#include "tools/drawing/run_trace.hpp"

namespace cohort::tool {

/// One experiment's run, with all that people see of it.
class OneRun {
 public:
  /// `command`, `log` and `stop`, whether the process was asked to end, must outlive this.
  OneRun(const RunCommand& command, Outputs outputs, Log& log, const std::atomic<bool>& stop);

  /// Before it runs, and again if another world takes the place of the one before: then only the recording goes on.
  /// Both must live until the next call, or until this is gone.
  void begin(const description::Experiment& experiment, const Simulation& simulation, recording::Beginning beginning);

  /// Of what has begun.
  session::RunListener listener();

  /// Prints and writes what was asked for, and closes the recording. The exit code.
  int finish(session::RunResult result, double cpu_seconds);

 private:
  bool write_files(const session::RunResult& result, double cpu_seconds);
  bool close_recording(session::RunResult& result);

  const RunCommand& command_;
  Outputs outputs_;
  Log& log_;
  const std::atomic<bool>& stop_;
  const description::Experiment* experiment_ = nullptr;
  const Simulation* simulation_ = nullptr;
  std::optional<Watchdog> watchdog_;  // while it runs
  std::optional<Terminal> terminal_;
  std::optional<TraceRecorder> trace_;
  std::optional<PrintedTable> table_;
  std::optional<recording::Recorder> recorder_;
  std::vector<recording::Recorder*> recorders_;  // it or none
};

}  // namespace cohort::tool
