// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>

#include "server/description/select_robots.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/recording_part.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/common/data/csv_tables.hpp"
#include "tools/common/data/hdf5_tables.hpp"
#include "tools/common/data/recording_tables.hpp"

namespace cohort::tool {
namespace {

struct ExportDataCommand {
  std::filesystem::path file;
  std::filesystem::path csv;   ///< folder; empty: hdf5
  std::filesystem::path hdf5;  ///< file; one of the two is not empty
  std::vector<std::string> robots{};
  RecordingPart part{};
};

// Returns the names of the selected robots in the recording's first world; empty if there are no selectors.
std::set<std::string> selected_names(const recording::Recording& recording, const std::vector<std::string>& selectors) {
  std::set<std::string> names;
  if (selectors.empty()) return names;
  const description::Experiment experiment = recording.experiment(recording.worlds().front());
  for (const std::string& selector : selectors)
    for (const std::uint32_t robot : description::select_robots(experiment.world, selector))
      names.insert(experiment.world.robot(robot).name);
  return names;
}

int export_data(const ExportDataCommand& command, Log& log) {
  refuse_experiment(command.file);
  const recording::Recording recording(command.file);
  if (!recording.damage().empty()) log.warning(recording.damage());
  data::Selection selection{.robots = selected_names(recording, command.robots)};
  selection.from = start_of_part(command.part);
  selection.to = end_of_part(command.part);
  if (!command.hdf5.empty()) check_writable("the tables", command.hdf5);
  const auto sink = command.csv.empty() ? data::hdf5_tables(command.hdf5) : data::csv_tables(command.csv);
  const std::uint64_t rows = data::write_tables(recording, selection, *sink);
  sink->finish();
  log.notice(
      fmt::format("wrote {} to {}", counted(rows, "row"), (command.csv.empty() ? command.hdf5 : command.csv).string()),
      {{"rows", rows}});
  return exit_ok;
}

}  // namespace

Subcommand add_export_data(CommandLine app) {
  const auto command = std::make_shared<ExportDataCommand>();
  CommandLine line = app.add_subcommand("export-data", "Convert a recording to tables");
  line.add_option("FILE", command->file, "Recording (MCAP)").required().type_name("");
  CommandLine target = line.add_alternatives("Target");
  target.add_option("--csv", command->csv, "Folder to which each table is written as a CSV file").type_name("DIR");
  target.add_option("--hdf5", command->hdf5, "HDF5 file to which all tables are written").type_name("FILE");
  add_robots_of_recording(line, command->robots);
  add_part_options(line, command->part);
  line.footer("Example: cohort export-data run.mcap --csv tables");
  return {line, [command](Log& log, const std::atomic<bool>&) { return export_data(*command, log); }};
}

}  // namespace cohort::tool
