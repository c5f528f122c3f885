#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "tools/cohort/commands/commands.hpp"

namespace cohort::tool {

/// What the command line says of the commands that read recordings.
struct RecordingCommands {
  ReplayCommand replay;
  DiffCommand diff;
  ExportDataCommand export_data;
  PlotCommand plot;
  RecoverCommand recover;
  CLI::App* replay_app = nullptr;
  CLI::App* diff_app = nullptr;
  CLI::App* export_data_app = nullptr;
  CLI::App* plot_app = nullptr;
  CLI::App* recover_app = nullptr;

  std::vector<CLI::App*> apps() const { return {replay_app, diff_app, export_data_app, plot_app, recover_app}; }
  /// Runs the one that was asked for; nothing if none was. The exit code.
  std::optional<int> run(Log& log, const std::atomic<bool>& stop) const;
};

/// Adds them to `app`. `commands` must outlive it.
void add_recording_commands(CLI::App& app, RecordingCommands& commands);

/// What `cohort run` and `cohort serve` record.
void add_record_options(CLI::App& app, RecordOptions& options);
/// What `cohort record` does.
void add_live_record_options(CLI::App& app, RecordOptions& options);

}  // namespace cohort::tool
