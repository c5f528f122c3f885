#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "server/recording/recorder.hpp"
#include "server/session/run.hpp"
#include "tools/cohort/cli/printed_table.hpp"
#include "tools/cohort/cli/terminal.hpp"
#include "tools/cohort/running/run_options.hpp"
#include "tools/drawing/plot_view.hpp"
#include "tools/drawing/run_trace.hpp"

namespace cohort::tool {

/// One experiment's run, with all that people see of it.
class OneRun {
 public:
  /// `outputs`: of this run. `recorder` has begun with `simulation`; null if nothing is recorded. All else must outlive
  /// this.
  OneRun(const RunCommand& command, Outputs outputs, const description::Experiment& experiment, Simulation& simulation,
         recording::Recorder* recorder, Log& log);

  session::RunListener listener();

  /// Prints and writes what was asked for. The exit code.
  int finish(const session::RunResult& result, double cpu_seconds);

 private:
  bool write_files(const session::RunResult& result, double cpu_seconds);

  const description::Experiment& experiment_;
  std::vector<recording::Recorder*> recorders_;  // one or none
  Log& log_;
  Outputs outputs_;
  Terminal terminal_;
  std::optional<TraceRecorder> trace_;
  std::optional<PrintedTable> table_;
};

/// Closes a run's recording, and tells what is missing in it. False if it ended before the run.
bool close_recording(recording::Recorder& recorder, const std::filesystem::path& file, const session::RunResult& result,
                     Log& log);

}  // namespace cohort::tool
