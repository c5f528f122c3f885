#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "tools/cohort/commands.hpp"
#include "tools/cohort/log.hpp"

namespace {

using namespace cohort::tool;

std::atomic<bool> stop_requested = false;

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = true; };
  action.sa_flags = SA_RESETHAND;  // a second one ends the process at once, whatever it is stuck in
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // but for nohup: the terminal was closed
}

void add_run_options(CLI::App& app, RunCommand& options, std::string& speed) {
  app.add_option("FILE", options.file, "Experiment (YAML)")->required();
  app.add_option("--threads", options.threads, "Threads that step the world; results do not depend on it")
      ->check(CLI::Range(1u, 1024u));
  app.add_option("--duration", options.duration, "Simulated seconds, instead of the experiment's")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "Seed, instead of the experiment's");
  app.add_option("--speed", speed, "Simulated seconds per second: max, or a number")->default_str("max");
  app.add_option("--summary", options.summary, "Write the summary to this file as JSON");
  app.add_option("--plot", options.plot, "Draw arena, paths and contacts to this file as SVG");
  app.add_option("--domain", options.domain, "DDS domain (default: $COHORT_DOMAIN, or a free one, or 0 for outsiders)")
      ->envname("COHORT_DOMAIN")
      ->check(CLI::Range(0u, 230u));
  app.add_flag("--quiet", options.quiet, "Print errors only");
}

double parse_speed(const std::string& text) {
  if (text == "max") return 0.0;
  std::size_t used = 0;
  double speed = 0.0;
  try {
    speed = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || !(speed > 0.0) || speed > 1e9)
    throw CLI::ValidationError("--speed", "is '" + text + "', expected max or a number above 0");
  return speed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Cohort: a deterministic simulator for groups of robots");
  app.set_version_flag("--version", COHORT_VERSION);
  app.require_subcommand(1);

  RunCommand run_options;
  std::string speed = "max";
  CLI::App* run_app = app.add_subcommand("run", "Run an experiment with its controllers");
  add_run_options(*run_app, run_options, speed);
  const std::map<std::string, Controllers> placements = {{"inprocess", Controllers::in_process},
                                                         {"process", Controllers::process},
                                                         {"per-robot", Controllers::per_robot},
                                                         {"external", Controllers::external}};
  run_app->add_option("--controllers", run_options.controllers, "Where controllers run")
      ->transform(CLI::CheckedTransformer(placements).description("inprocess|process|per-robot|external"))
      ->default_str("process");

  RunCommand serve_options;
  serve_options.controllers = Controllers::external;
  CLI::App* serve_app = app.add_subcommand("serve", "Run an experiment alone and wait for controllers to attach");
  add_run_options(*serve_app, serve_options, speed);
  serve_app->add_option("--network", serve_options.network, "Address of the interface to serve on")
      ->capture_default_str();

  HostCommand host_options;
  CLI::App* host_app = app.add_subcommand("host", "Run a controller plugin for some robots of a server");
  host_app->add_option("PLUGIN", host_options.plugin, "Name of a controller, or path to its plugin")->required();
  host_app->add_option("--robots", host_options.robots, "all, an id, A..B, or a name with *; may repeat")
      ->required()
      ->delimiter(',');
  host_app->add_option("--server", host_options.server, "Address of the server")
      ->envname("COHORT_SERVER")
      ->default_str("127.0.0.1");
  host_app->add_option("--domain", host_options.domain, "DDS domain of the server")
      ->envname("COHORT_DOMAIN")
      ->check(CLI::Range(0u, 230u));

  std::filesystem::path checked_file;
  CLI::App* check_app =
      app.add_subcommand("check", "Read a world or an experiment, run nothing, explain what is wrong");
  check_app->add_option("FILE", checked_file, "Experiment (.yaml) or world (.sdf)")->required();

  try {
    app.parse(argc, argv);
    run_options.speed = serve_options.speed = parse_speed(speed);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ok : exit_usage;
  }

  set_up_log();
  stop_on_signals();
  if (host_options.server.empty()) host_options.server = "127.0.0.1";
  if (run_app->parsed()) return run(run_options, stop_requested);
  if (serve_app->parsed()) return run(serve_options, stop_requested);
  if (host_app->parsed()) return host(host_options, stop_requested);
  return check(checked_file);
}
