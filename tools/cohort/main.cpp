#include <cstdlib>
#include <iostream>
#include <limits>

#include "client_sdk/src/program.hpp"
#include "idl/wire.hpp"
#include "server/core/text.hpp"
#include "tools/cohort/commands/bench_options.hpp"
#include "tools/cohort/cli/build_facts.hpp"
#include "tools/cohort/commands/client_commands.hpp"
#include "tools/cohort/commands/command_lines.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/cli/log.hpp"
#include "tools/cohort/commands/page_commands.hpp"
#include "tools/cohort/commands/recording_options.hpp"
#include "tools/cohort/cli/usage.hpp"

namespace {

using namespace cohort::tool;

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): Cyclone has one log for the process.
Log* dds_log = nullptr;

struct LogFlags {
  std::string format;
  bool verbose = false;
  bool quiet = false;
};

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

const std::vector<std::string> log_formats = {"text", "json"};
const std::vector<std::pair<std::string, LogLevel>> log_levels = {{"debug", LogLevel::debug},
                                                                  {"info", LogLevel::info},
                                                                  {"warn", LogLevel::warning},
                                                                  {"error", LogLevel::error},
                                                                  {"off", LogLevel::off}};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

LogLevel level_from_environment() {
  const std::string text = environment("COHORT_LOG");
  if (text.empty()) return LogLevel::warning;
  std::vector<std::string> names;
  for (const auto& [name, level] : log_levels) {
    if (name == text) return level;
    names.push_back(name);
  }
  throw UsageError("COHORT_LOG is '" + text + "'" + cohort::suggestion(text, names));
}

LogFormat log_format(std::string text) {
  if (text.empty()) text = environment("COHORT_LOG_FORMAT");
  if (text.empty() || text == "text") return LogFormat::text;
  if (text == "json") return LogFormat::json;
  throw UsageError("COHORT_LOG_FORMAT is '" + text + "'" + cohort::suggestion(text, log_formats));
}

LogOptions log_options(const LogFlags& flags) {
  LogOptions options;
  options.format = log_format(flags.format);
  options.level = level_from_environment();
  if (flags.verbose && flags.quiet) throw UsageError("choose one of --verbose and --quiet");
  if (flags.verbose) options.level = std::min(options.level, LogLevel::info);
  if (flags.quiet) options.level = std::max(options.level, LogLevel::error);
  options.progress = !flags.quiet && options.level != LogLevel::off;
  return options;
}

// For a command line that cannot be read, and so does not say it as such.
LogFormat format_of_unreadable(int argc, char** argv) {
  bool is_json = environment("COHORT_LOG_FORMAT") == "json";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with("--log-format=")) is_json = argument.ends_with("=json");
    if (argument == "--log-format" && i + 1 < argc) is_json = std::string_view(argv[i + 1]) == "json";
  }
  return is_json ? LogFormat::json : LogFormat::text;
}

void add_log_options(CLI::App& app, LogFlags& flags) {
  app.add_option("--log-format", flags.format, "Messages as text or as json (default: $COHORT_LOG_FORMAT, or text)")
      ->check(one_of(log_formats))
      ->type_name("text|json");
  app.add_flag("--verbose", flags.verbose, "Say what happens, not only what goes wrong; $COHORT_LOG has more levels");
}

void add_run_options(CLI::App& app, RunCommand& options, std::string& speed, LogFlags& flags) {
  app.add_option("--repeat", options.repeat,
                 "How often to run it, the world built anew each time, the controllers attached")
      ->check(whole_number(1, 1'000'000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--threads", options.threads,
                 "Threads that step the world, with the same results (default: the cores that it may use)")
      ->check(whole_number(1, 1024))
      ->type_name("N");
  app.add_option("--duration", options.duration, "Simulated seconds, instead of the experiment's")
      ->check(number_above_zero(most_seconds))
      ->type_name("S");
  app.add_option("--seed", options.seed, "Seed, instead of the experiment's")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->type_name("N");
  app.add_option("--speed", speed,
                 "Simulated seconds per second at the most (default: max, or 1 if people drive or look)")
      ->check(max_or_number_above_zero(1e9))
      ->type_name("max|X");
  app.add_option("--summary", options.summary, "Write the summary to this file as JSON")->type_name("FILE");
  app.add_option("--plot", options.plot, "Draw arena, paths and contacts to this file as SVG")->type_name("FILE");
  const auto set_view = [&options](const std::string& view) {
    options.viewpoint = view == "side" ? Viewpoint::side : Viewpoint::above;
  };
  app.add_option_function<std::string>("--plot-view", set_view,
                                       "Of the plot: from above (the default), or from the side")
      ->check(one_of({"above", "side"}))
      ->type_name("above|side");
  app.add_option("--csv", options.csv, "Write what the experiment prints to this file as CSV")->type_name("FILE");
  add_record_options(app, options.record);
  CLI::Option* const view = app.add_flag("--view", options.view, "Show it in a browser, as 'cohort view' does");
  app.add_flag("--control", options.view_controls, "With --view: let whoever looks control it")->needs(view);
  app.add_flag("--paused", options.paused, "Begin paused, until 'cohort ctl resume' or 'step'");
  app.add_option("--keep-snapshots", options.keep_interval,
                 "Simulated seconds between snapshots in memory, for 'cohort ctl back' (default: none)")
      ->check(number_above_zero(most_seconds))
      ->type_name("S");
  app.add_option("--from", options.from, "Go on from this snapshot of 'cohort ctl save'")->type_name("FILE");
  add_domains(app, options.domains, "DDS domains to serve (default: free ones, or 0 if others start controllers)");
  add_secure_option(app, options.secure, "Folder of 'cohort security': nobody else gets in (default: $COHORT_SECURE)");
  add_log_options(app, flags);
  app.add_flag("--quiet", flags.quiet, "Print errors only");
}

template <class Command>
void add_client_options(CLI::App& app, Command& command) {
  app.add_option("--robots", command.robots, "Which robots: all, an id, ids A..B, or a name with *; several by commas")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("SEL[,SEL...]");
  add_server_option(app, command.server);
  add_domains(app, command.domains, "DDS domain of the server, or a range: then one of it (default: 0)");
  add_secure_option(app, command.secure, "Folder of this client's identity (default: $COHORT_SECURE)");
}

void add_samples_options(CLI::App& app, SamplesCommand& command) {
  constexpr double longest = 1e3;  // [m]
  app.add_option("MODEL", command.file, "Model, or world whose first robot is meant")->required()->type_name("");
  app.add_option("DEVICE", command.device, "Name of its proximity_ring")->required()->type_name("");
  app.add_option("-o,--output", command.output, "File to write")->required()->type_name("FILE");
  app.add_option("--radius", command.grid.radius, "Radius of the cylinder in metres")
      ->check(number_above_zero(longest))
      ->capture_default_str()
      ->type_name("M");
  app.add_option("--height", command.grid.height, "Height of the cylinder in metres")
      ->check(number_above_zero(longest))
      ->capture_default_str()
      ->type_name("M");
  app.add_option("--distances", command.grid.distances, "How many distances, from contact to the end of the range")
      ->check(whole_number(2, 10'000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--angles", command.grid.angles, "How many angles, evenly all round")
      ->check(whole_number(1, 10'000))
      ->capture_default_str()
      ->type_name("N");
  app.footer("Example: cohort samples worlds/robots/sbot/model.sdf proximity -o proximity.csv");
}

void log_dds_to(Log& log) {
  dds_log = &log;
  cohort::wire::set_dds_log([](std::string_view message, cohort::wire::DdsLogKind kind) noexcept {
    using cohort::wire::DdsLogKind;
    if (kind == DdsLogKind::refusal) return dds_log->warning(std::string(message));
    dds_log->write(kind == DdsLogKind::fatal ? LogLevel::error : LogLevel::debug, "dds: " + std::string(message));
  });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Cohort: a deterministic simulator for groups of robots", "cohort");
  app.set_version_flag("--version", version_text, "Print the version, and how this was built");
  app.set_help_flag("-h,--help", "Print this text and exit");
  app.require_subcommand(1);
  LogFlags log_flags;
  add_log_options(app, log_flags);
  app.footer(
      "Example: cohort run worlds/experiments/obstacle_avoidance.yaml --duration 10\n"
      "'cohort COMMAND --help' says more, 'cohort help' what may be written in files. Exit codes: 0 done, 1 the run "
      "failed, 2 a mistake in the command line, the\n"
      "files or the set-up, 130 interrupted.");

  RunCommand run_options;
  std::string speed;
  std::string controllers = "process";
  const std::map<std::string, Controllers> placements = {{"inprocess", Controllers::in_process},
                                                         {"process", Controllers::process},
                                                         {"per-robot", Controllers::per_robot},
                                                         {"external", Controllers::external}};
  CLI::App* run_app = app.add_subcommand("run", "Run an experiment with its controllers");
  run_app->add_option("FILE", run_options.files.emplace_back(), "Experiment (YAML)")->required()->type_name("");
  add_run_options(*run_app, run_options, speed, log_flags);
  run_app
      ->add_option("--controllers", controllers,
                   "process for each team (the default), per-robot, inprocess with the server, or external")
      ->check(one_of({"process", "per-robot", "inprocess", "external"}))
      ->type_name("process|per-robot|inprocess|external");
  run_app->footer("Example: cohort run worlds/experiments/obstacle_avoidance.yaml --duration 10 --plot run.svg");

  RunCommand serve_options;
  serve_options.controllers = Controllers::external;
  CLI::App* serve_app = app.add_subcommand("serve", "Run an experiment alone and wait for controllers to attach");
  serve_app->add_option("FILE", serve_options.files, "Experiments (YAML), run one after the other")
      ->required()
      ->type_name("");
  add_run_options(*serve_app, serve_options, speed, log_flags);
  serve_app->add_option("--network", serve_options.network, "Address of the interface to serve on")
      ->envname("COHORT_NETWORK")
      ->capture_default_str()
      ->type_name("ADDRESS");
  serve_app->footer("Example: cohort serve worlds/experiments/obstacle_avoidance.yaml --domain 7 --network 10.0.0.5");

  HostCommand host_options;
  CLI::App* host_app = app.add_subcommand("host", "Run a controller plugin for some robots of a server");
  host_app->add_option("PLUGIN", host_options.plugin, "Name of a controller, or path to its plugin")
      ->required()
      ->type_name("");
  add_client_options(*host_app, host_options);
  add_log_options(*host_app, log_flags);
  host_app->add_flag("--inline", host_options.inline_step,
                     "Step on the thread that receives, while steps take less than 1 ms: a quicker answer");
  host_app->add_flag("--for-run", host_options.for_run)->group("");  // `cohort run` starts it so
  host_app->footer("Example: cohort host obstacle_avoidance --robots 0..7 --server 10.0.0.5 --domain 7");

  TeleopCommand teleop_options;
  CLI::App* teleop_app = app.add_subcommand("teleop", "Drive robots of a server by keyboard");
  add_client_options(*teleop_app, teleop_options);
  add_log_options(*teleop_app, log_flags);
  teleop_app->footer("Example: cohort teleop --robots 0");

  ClientCommands client_commands;
  add_client_commands(app, client_commands);
  for (CLI::App* client_app : client_commands.apps()) add_log_options(*client_app, log_flags);

  std::filesystem::path checked_file;
  CLI::App* check_app =
      app.add_subcommand("check", "Read a world or an experiment, run nothing, explain what is wrong");
  check_app->add_option("FILE", checked_file, "Experiment (.yaml) or world (.sdf)")->required()->type_name("");
  add_log_options(*check_app, log_flags);
  check_app->footer("Example: cohort check worlds/arenas/obstacles.sdf");

  ExportCommand export_options;
  CLI::App* export_app = app.add_subcommand("export", "Write a world, or that of an experiment, as SDF or YAML");
  export_app->add_option("FILE", export_options.file, "World, model or experiment")->required()->type_name("");
  export_app->add_option("-o,--output", export_options.output, "File to write, .sdf or .yaml")
      ->required()
      ->type_name("FILE");
  export_app->add_option("--seed", export_options.seed, "Seed of the populations, instead of the experiment's")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->type_name("N");
  add_log_options(*export_app, log_flags);
  export_app->footer("Example: cohort export worlds/arenas/obstacles.sdf -o placed.sdf");

  SamplesCommand samples_options;
  CLI::App* samples_app = app.add_subcommand("samples", "Write what a ring of proximity sensors reads of a cylinder");
  add_samples_options(*samples_app, samples_options);
  add_log_options(*samples_app, log_flags);

  SecurityCommand security_command;
  CLI::App* security_app = app.add_subcommand("security", "Make and list who may drive what, with certificates");
  add_security_commands(*security_app, security_command);
  add_log_options(*security_app, log_flags);

  DoctorCommand doctor_command;
  CLI::App* doctor_app = app.add_subcommand("doctor", "Look for what usually goes wrong, and say what to do");
  add_doctor_options(*doctor_app, doctor_command);
  add_log_options(*doctor_app, log_flags);

  RecordingCommands recording_commands;
  add_recording_commands(app, recording_commands);
  for (CLI::App* recording_app : recording_commands.apps()) add_log_options(*recording_app, log_flags);

  std::string help_topic;
  CLI::App* help_app = app.add_subcommand("help", "Manual of what may be written in worlds and experiments");
  help_app->add_option("TOPIC", help_topic, "Such as sensors, placement, proximity_ring or events")->type_name("");
  add_log_options(*help_app, log_flags);
  help_app->footer("Example: cohort help sensors");

  const PageCommands page_commands(app);
  for (CLI::App* page_app : page_commands.apps()) add_log_options(*page_app, log_flags);

  BenchOptions bench_options;
  CLI::App* bench_app = add_bench(app, bench_options);
  add_log_options(*bench_app, log_flags);

  std::optional<LogOptions> options;
  try {
    app.parse(argc, argv);
    options = log_options(log_flags);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    Log({.format = format_of_unreadable(argc, argv)}).error(usage_error(app, error));
    return exit_usage;
  } catch (const UsageError& error) {
    Log({.format = format_of_unreadable(argc, argv)}).error(error.what());
    return exit_usage;
  }
  run_options.controllers = placements.at(controllers);
  if (!speed.empty())
    run_options.speed = serve_options.speed = speed == "max" ? 0.0 : *cohort::parse_real(speed);
  run_options.quiet = serve_options.quiet = log_flags.quiet;

  Log log(*options);
  log_dds_to(log);
  const std::atomic<bool>& stop_requested = cohort::stop_on_signals();
  if (run_app->parsed()) return run(run_options, log, stop_requested);
  if (serve_app->parsed()) return run(serve_options, log, stop_requested);
  if (host_app->parsed()) return host(host_options, log, stop_requested);
  if (teleop_app->parsed()) return teleop(teleop_options, log, stop_requested);
  if (const auto code = client_commands.run(log, stop_requested)) return *code;
  if (export_app->parsed()) return export_world(export_options, log);
  if (samples_app->parsed()) return take_samples(samples_options, log);
  if (security_app->parsed()) return security(security_command, log);
  if (doctor_app->parsed()) return doctor(doctor_command, log);
  if (const auto code = recording_commands.run(log, stop_requested)) return *code;
  if (help_app->parsed()) return help(help_topic, log);
  if (const auto code = page_commands.run()) return *code;
  if (bench_app->parsed()) return bench(bench_options.command(), log, stop_requested);
  return check(checked_file, log);
}
