#include "tools/cohort/commands/bench_options.hpp"

#include <limits>

#include "tools/bench/bench.hpp"
#include "tools/cohort/cli/usage.hpp"

namespace cohort::tool {
namespace {

void add_bench_options(CLI::App& app, BenchCommand& command) {
  bench::Options& options = command.options;
  const auto list = [&](const char* name, auto& values, const char* text) {
    return app.add_option(name, values, text)->delimiter(',')->allow_extra_args(false);
  };
  list("--scene", options.scenes, "Scenes (default: all)")
      ->check(one_of(bench::scene_names()))
      ->type_name("NAME[,NAME...]");
  list("--engines", options.engines, "Engines to compare (default: all in this build)")
      ->check(one_of(bench::engine_names()))
      ->type_name("NAME[,NAME...]");
  list("--robots", options.robots, "How many robots, one run for each number (default: some for each scene)")
      ->check(whole_number(1, 100'000))
      ->type_name("N[,N...]");
  app.add_option("--seconds", options.seconds, "Simulated seconds of each repetition")
      ->check(number_above_zero(1e6))
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--repetitions", options.repetitions, "Repetitions, the engines in turns")
      ->check(whole_number(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--threads", options.threads, "Run Cohort with this many threads too, in turns with one")
      ->check(whole_number(1, 1024))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--seed", options.seed, "Seed of places and commands")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--json", command.json, "Write the results to this file as JSON")->type_name("FILE");
  app.footer(
      "Scenes: crowd (in a walled square), free (apart), crowd_wheels (Cohort too has wheels as bodies),\n"
      "crowd_planar (Cohort in the plane only), chain (connected robots), rays, build (time and memory),\n"
      "accuracy (against closed forms).\n"
      "Engines: cohort, and as Debian ships them ode-worldstep, ode-quickstep, mujoco and enki.\n"
      "All engines get the same robots, places, commands and step, in this process, in turns. They differ in what\n"
      "they can express: ODE, MuJoCo and Enki have wheels where Cohort has tracks; MuJoCo's motors lose torque with\n"
      "speed; Enki is flat, without turrets, joints or torque limits. docs/bench.md says all of it.\n"
      "Example: cohort bench --scene crowd --robots 128,1000 --json results.json");
}

void add_thesis_options(CLI::App& app, bench::ThesisOptions& options, BenchCommand& command) {
  app.add_option("--seconds", options.seconds, "Simulated seconds of each cell")
      ->check(number_above_zero(1e6))
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--budget", options.budget, "CPU seconds that a cell may take; the rest is extrapolated")
      ->check(number_above_zero(1e6))
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--seed", options.seed, "Seed of places and commands")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--table", options.tables, "Tables (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of(bench::thesis_tables()))
      ->type_name("NAME[,NAME...]");
  app.add_option("--robots", options.robots, "How many robots, a row for each number (default: the thesis's, and more)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(whole_number(1, 100'000))
      ->type_name("N[,N...]");
  app.add_option("--json", command.json, "Write the results to this file as JSON")->type_name("FILE");
  app.footer(
      "Tables 5.1 (random movement) and 5.2 (connected robots): the thesis's own seconds, and beside them Cohort and\n"
      "ODE, the thesis's engine, run here and now with steps of 10 ms; ODE also with the thesis's 100 ms, and what "
      "its\n"
      "robots then do (behaviour). Tables 5.3 (proximity sensors) and 5.4 (light and sound): robots that stand still,\n"
      "beside rays of ODE. docs/bench.md says all of it.");
}

void add_lockstep_options(CLI::App& app, BenchOptions& all) {
  bench::LockstepOptions& options = all.lockstep;
  const auto list = [&](const char* name, auto& values, const char* text) {
    return app.add_option(name, values, text)->delimiter(',')->allow_extra_args(false);
  };
  std::vector<std::string> names;
  for (const auto& [name, placement] : bench::placements()) names.push_back(name);
  list("--robots", options.robots, "How many robots, a row for each number")
      ->check(whole_number(1, 10'000))
      ->capture_default_str()
      ->type_name("N[,N...]");
  list("--placement", all.placements, "All robots in one process, in eights, or each in one (default: all three)")
      ->check(one_of(names))
      ->type_name("WHERE[,WHERE...]");
  app.add_option("--seconds", options.seconds, "Wall time of each repetition, of Cohort and of UDP each")
      ->check(number_above_zero(1e4))
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--repetitions", options.repetitions, "Repetitions, Cohort and UDP in turns")
      ->check(whole_number(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  app.add_flag("--own-thread{false}", options.inline_step,
               "Clients step on a thread of their own, as 'cohort host' does without --inline");
  CLI::Option* look_ahead =
      app.add_flag("--look-ahead", options.look_ahead,
                   "Measure a physics and a controller that compute for the same time, with and without a delay");
  app.add_option("--json", all.scenes.json, "Write the results to this file as JSON")->type_name("FILE");
  app.add_option("--svg", all.scenes.svg, "Draw the results to this file as SVG")
      ->type_name("FILE")
      ->excludes(look_ahead);
  app.footer(
      "A server and its clients in lockstep over DDS, beside the same bytes between as many processes over raw UDP, "
      "in\n"
      "turns. docs/bench.md says all of it.\n"
      "Example: cohort bench lockstep --robots 8,128 --placement eights");
}

// What `cohort bench lockstep` starts.
void add_client_options(CLI::App& app, bench::BenchClient& client) {
  app.add_option("--robots", client.robots)->delimiter(',')->allow_extra_args(false);
  app.add_option("--domain", client.domain);
  app.add_option("--work", client.work);
  app.add_flag("--inline", client.inline_step);
  app.add_option("--udp-port", client.udp.port);
  app.add_option("--number", client.udp.number);
  app.add_option("--command-bytes", client.udp.command_bytes);
}

}  // namespace

CLI::App* add_bench(CLI::App& app, BenchOptions& options) {
  CLI::App* bench = app.add_subcommand("bench", "Measure Cohort and other physics engines on the same scenes");
  add_bench_options(*bench, options.scenes);
  options.thesis_app = bench->add_subcommand("thesis", "Run the tables of the thesis of 2005 again");
  add_thesis_options(*options.thesis_app, options.thesis, options.scenes);
  options.lockstep_app = bench->add_subcommand("lockstep", "Measure what the barrier costs, beside raw UDP");
  add_lockstep_options(*options.lockstep_app, options);
  options.client_app = bench->add_subcommand("client")->group("");
  add_client_options(*options.client_app, options.client);
  return bench;
}

BenchCommand BenchOptions::command() const {
  BenchCommand command = scenes;
  if (thesis_app->parsed()) command.thesis = thesis;
  if (client_app->parsed()) command.client = client;
  if (!lockstep_app->parsed()) return command;
  command.lockstep = lockstep;
  if (!placements.empty()) command.lockstep->placements.clear();
  for (const std::string& wanted : placements)
    for (const auto& [name, placement] : bench::placements())
      if (name == wanted) command.lockstep->placements.push_back(placement);
  return command;
}

}  // namespace cohort::tool
