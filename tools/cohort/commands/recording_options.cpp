#include "tools/cohort/commands/recording_options.hpp"

#include "tools/cohort/cli/usage.hpp"

namespace cohort::tool {
namespace {

void add_part_options(CLI::App& app, RecordingPart& part) {
  app.add_option("--from", part.from, "Time in the recording to begin at, in simulated seconds (default: 0)")
      ->check(number_from_zero(most_seconds))
      ->type_name("S");
  app.add_option("--to", part.to, "Time to end at (default: the end)")
      ->check(number_from_zero(most_seconds))
      ->type_name("S");
}

void add_robots_of_recording(CLI::App& app, std::vector<std::string>& robots) {
  app.add_option("--robots", robots, "Which robots, as of 'cohort host' (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("SEL[,SEL...]");
}

void add_export_data_options(CLI::App& app, ExportDataCommand& command) {
  app.add_option("FILE", command.file, "Recording (MCAP)")->required()->type_name("");
  CLI::Option_group& target = *app.add_option_group("Target");
  target.add_option("--csv", command.csv, "Folder for a CSV file for each table")->type_name("DIR");
  target.add_option("--hdf5", command.hdf5, "HDF5 file for all of them")->type_name("FILE");
  target.require_option(1);
  add_robots_of_recording(app, command.robots);
  add_part_options(app, command.part);
  app.footer("Example: cohort export-data run.mcap --csv tables");
}

void add_plot_options(CLI::App& app, PlotCommand& command) {
  app.add_option("FILE", command.file, "Recording (MCAP)")->required()->type_name("");
  app.add_option("-o,--output", command.output, "Picture to write (.svg or .png)")->required()->type_name("FILE");
  app.add_option("--what", command.what, "Over time: speed, or channels such as proximity/3/reading (default: paths)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("WHAT[,WHAT...]");
  add_robots_of_recording(app, command.robots);
  const auto set_view = [&command](const std::string& view) {
    command.viewpoint = view == "side" ? Viewpoint::side : Viewpoint::above;
  };
  app.add_option_function<std::string>("--view", set_view, "Of paths: from above (the default), or from the side")
      ->check(one_of({"above", "side"}))
      ->type_name("above|side");
  add_part_options(app, command.part);
  app.footer("Example: cohort plot run.mcap --what speed,proximity/0/reading --robots 0..3 -o speeds.svg");
}

void add_replay_options(CLI::App& app, ReplayCommand& command) {
  app.add_option("FILE", command.file, "Recording (MCAP)")->required()->type_name("");
  app.add_flag("--verify", command.verify, "Compare the state of every tick with the recorded one");
  add_part_options(app, command.part);
  app.add_option("--threads", command.threads, "Threads that step the world (default: the cores)")
      ->check(whole_number(1, 1024))
      ->type_name("N");
  app.add_flag("--quiet", command.quiet, "Print errors and differences only");
  app.footer("Example: cohort replay run.mcap --verify");
}

void add_diff_options(CLI::App& app, DiffCommand& command) {
  app.add_option("FIRST", command.first, "Recording (MCAP)")->required()->type_name("");
  app.add_option("SECOND", command.second, "Another one")->required()->type_name("");
  app.add_flag("--json", command.json, "Print it as JSON");
  app.footer("Example: cohort diff monday.mcap tuesday.mcap");
}

void add_recover_options(CLI::App& app, RecoverCommand& command) {
  app.add_option("FILE", command.file, "Recording (.mcap)")->required()->type_name("");
  app.add_option("-o,--output", command.output, "File to write (default: FILE itself is replaced)")->type_name("FILE");
  app.footer("Example: cohort recover run.mcap");
}

}  // namespace

void add_recording_commands(CLI::App& app, RecordingCommands& commands) {
  commands.replay_app = app.add_subcommand("replay", "Run a recording's world again, without controllers");
  add_replay_options(*commands.replay_app, commands.replay);
  commands.diff_app = app.add_subcommand("diff", "Find where two recorded runs part, and in what");
  add_diff_options(*commands.diff_app, commands.diff);
  commands.export_data_app = app.add_subcommand("export-data", "Write a recording as tables");
  add_export_data_options(*commands.export_data_app, commands.export_data);
  commands.plot_app = app.add_subcommand("plot", "Draw a recording: paths, speeds, what robots sense");
  add_plot_options(*commands.plot_app, commands.plot);
  commands.recover_app = app.add_subcommand("recover", "Make a whole recording of what can be read of a damaged one");
  add_recover_options(*commands.recover_app, commands.recover);
}

std::optional<int> RecordingCommands::run(Log& log, const std::atomic<bool>& stop) const {
  if (replay_app->parsed()) return tool::replay(replay, log, stop);
  if (diff_app->parsed()) return tool::diff(diff, log, stop);
  if (export_data_app->parsed()) return tool::export_data(export_data, log);
  if (plot_app->parsed()) return tool::plot(plot, log, stop);
  if (recover_app->parsed()) return tool::recover(recover, log);
  return std::nullopt;
}

namespace {

// `prefix`: of the options' names.
void add_recorded_options(CLI::App& app, RecordOptions& options, const std::string& prefix) {
  constexpr double most_hertz = 1e9;
  app.add_option(prefix + "poses", options.pose_rate, "Poses a simulated second in it, 0 for none")
      ->check(number_from_zero(most_hertz))
      ->type_name("HZ");
  app.add_option(prefix + "joints", options.joint_rate, "Joint states and poses of all links a simulated second")
      ->check(number_from_zero(most_hertz))
      ->type_name("HZ");
  app.add_option(prefix + "observations", options.observation_rate, "Observations of a robot a simulated second")
      ->check(number_from_zero(most_hertz))
      ->type_name("HZ");
  app.add_option(prefix + "robots", options.robots, "Whose observations: as --robots of 'cohort host'")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("SEL[,SEL...]");
  app.add_option(prefix + "snapshots", options.snapshot_interval, "Simulated seconds between snapshots, 0 for none")
      ->check(number_from_zero(most_seconds))
      ->type_name("S");
}

}  // namespace

void add_record_options(CLI::App& app, RecordOptions& options) {
  app.add_option("--record", options.file, "Record the run to this file (MCAP)")->type_name("FILE");
  add_recorded_options(app, options, "--record-");
}

void add_live_record_options(CLI::App& app, RecordOptions& options) {
  app.add_option("-o,--output", options.file, "File to write (MCAP)")->required()->type_name("FILE");
  add_recorded_options(app, options, "--");
  app.footer("Example: cohort record --server 10.0.0.5 --domain 7 -o run.mcap");
}

}  // namespace cohort::tool
