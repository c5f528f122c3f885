// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "idl/text/standard_streams.hpp"
#include "tests/benchmarks/comparison/bench.hpp"
#include "tests/benchmarks/comparison/lockstep/bench_client.hpp"
#include "tests/benchmarks/comparison/lockstep/lockstep.hpp"
#include "tests/benchmarks/comparison/thesis/thesis.hpp"
#include "tools/cli/common/build_facts.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/run_program.hpp"
#include "tools/cli/common/shown.hpp"

// The program cohort-bench.
namespace {

using namespace cohort;
using namespace cohort::tool;

struct BenchCommand {
  enum class What { scenes, thesis, lockstep, client };
  What what = What::scenes;
  bench::Options scenes{};
  bench::ThesisOptions thesis{};          ///< tables of the thesis
  bench::LockstepOptions lockstep{};      ///< measurement of the barrier
  std::vector<std::string> placements{};  ///< placements of `lockstep`; empty: all
  bench::BenchClient client{};            ///< options of a client process
  std::filesystem::path json{};           ///< file to write; empty: none
  std::filesystem::path svg{};            ///< graph of `lockstep`; empty: none
};

int measure_scenes(const BenchCommand& command, Log& log, const bench::Surroundings& surroundings) {
  constexpr const char* what = "the results";
  try {
    bench::check_engines(command.scenes);
    if (!command.json.empty()) check_writable(what, command.json);
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
  write_output(bench::missing_engines());
  flush_output();
  const auto print = [&](const std::string& table) {
    log.clear_progress();
    write_output("\n" + table);
    flush_output();
  };
  const auto results = command.what == BenchCommand::What::thesis
                           ? bench::measure_thesis(command.thesis, surroundings, print)
                           : bench::measure_all(command.scenes, surroundings, print);
  if (!command.json.empty()) write_file(what, command.json, json_text(results, 2) + "\n");
  return exit_ok;
}

int measure_lockstep(const BenchCommand& command, Log& log, const bench::Surroundings& surroundings) {
  constexpr const char* what = "the results";
  constexpr const char* graph = "the graph";
  try {
    if (!command.json.empty()) check_writable(what, command.json);
    if (!command.svg.empty()) check_writable(graph, command.svg);
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
  bench::LockstepOptions options = command.lockstep;
  if (!command.placements.empty()) options.placements.clear();
  for (const std::string& wanted : command.placements)
    for (const auto& [name, placement] : bench::placements())
      if (name == wanted) options.placements.push_back(placement);
  const auto results = bench::measure_lockstep(options, surroundings, [&](const std::string& line) {
    log.clear_progress();
    write_output(line);
    flush_output();
  });
  if (!command.json.empty()) write_file(what, command.json, json_text(results.json, 2) + "\n");
  if (!command.svg.empty()) write_file(graph, command.svg, results.graph);
  return exit_ok;
}

int measure(const BenchCommand& command, Log& log, const std::atomic<bool>& stop) {
  const bench::Surroundings surroundings{[&](const std::string& message) { log.progress(message); }, stop};
  try {
    switch (command.what) {
      case BenchCommand::What::client: return bench::run_bench_client(command.client, stop);
      case BenchCommand::What::lockstep: return measure_lockstep(command, log, surroundings);
      case BenchCommand::What::scenes:
      case BenchCommand::What::thesis: break;
    }
    return measure_scenes(command, log, surroundings);
  } catch (const bench::Interrupted&) {
    return exit_interrupted;
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_failed;
  }
}

void add_scenes_options(CommandLine line, BenchCommand& command) {
  bench::Options& options = command.scenes;
  line.add_option("--scene", options.scenes, "Scenes (default: all)")
      .comma_separated()
      .check(one_of(bench::scene_names()))
      .type_name("NAME[,NAME...]");
  line.add_option("--engines", options.engines, "Engines to compare (default: all in this build)")
      .comma_separated()
      .check(one_of(bench::engine_names()))
      .type_name("NAME[,NAME...]");
  line.add_option("--robots", options.robots,
                  "Numbers of robots; one measurement for each (default: depends on the scene)")
      .comma_separated()
      .check(whole_number(1, 100'000))
      .type_name("N[,N...]");
  line.add_option("--seconds", options.seconds, "Duration of each repetition, in simulated seconds")
      .check(number_above_zero(1e6, "seconds"))
      .capture_default_str()
      .type_name("S");
  line.add_option("--repetitions", options.repetitions, "Number of repetitions; the engines alternate")
      .check(whole_number(1, 1000))
      .capture_default_str()
      .type_name("N");
  line.add_option("--threads", options.threads,
                  "Also measure Cohort with this number of threads, in turn with one thread")
      .check(whole_number(1, 1024))
      .capture_default_str()
      .type_name("N");
  line.add_option("--seed", options.seed, "Seed for poses and commands")
      .check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      .capture_default_str()
      .type_name("N");
  line.add_option("--json", command.json, "Write the results to this file as JSON").type_name("FILE");
  line.footer(
      "Scenes with robots: crowd (in a walled square), free (no contacts between robots), crowd_wheels (Cohort\n"
      "simulates wheels too), crowd_planar (Cohort simulates the plane only) and chain (connected robots).\n"
      "Other scenes: rays, build (time and memory) and accuracy (compared with closed-form solutions).\n"
      "Engines: cohort (default dynamics: Bullet's articulated-body algorithm), cohort-matrix (Cohort with\n"
      "'dynamics: cohort'), bullet (a plain Bullet world), ode-worldstep, ode-quickstep, mujoco and enki.\n"
      "All engines take turns in this process, with the same robots, poses, commands and steps. Their models\n"
      "differ: the others have wheels where Cohort has tracks. The torque of MuJoCo's motors decreases with speed.\n"
      "Enki is planar, without turrets, joints or torque limits. docs/bench.md describes scenes and engines.\n"
      "Example: cohort-bench --scene crowd --robots 128,1000 --json results.json");
}

void add_thesis_options(CommandLine line, BenchCommand& command) {
  bench::ThesisOptions& options = command.thesis;
  line.add_option("--seconds", options.seconds, "Simulated seconds for each cell of a table")
      .check(number_above_zero(1e6, "seconds"))
      .capture_default_str()
      .type_name("S");
  line.add_option("--budget", options.budget,
                  "Limit of CPU seconds for each cell; the results of longer runs are extrapolated")
      .check(number_above_zero(1e6, "seconds"))
      .capture_default_str()
      .type_name("S");
  line.add_option("--seed", options.seed, "Seed for poses and commands")
      .check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      .capture_default_str()
      .type_name("N");
  line.add_option("--table", options.tables, "Tables (default: all)")
      .comma_separated()
      .check(one_of(bench::thesis_tables()))
      .type_name("NAME[,NAME...]");
  line.add_option("--robots", options.robots,
                  "Numbers of robots; one row for each (default: those of the thesis and larger ones)")
      .comma_separated()
      .check(whole_number(1, 100'000))
      .type_name("N[,N...]");
  line.add_option("--json", command.json, "Write the results to this file as JSON").type_name("FILE");
  line.footer(
      "Tables 5.1 (random movement) and 5.2 (connected robots): the times in the thesis, compared with Cohort and "
      "with\n"
      "ODE, the engine of the thesis. Both run on this machine with steps of 10 ms. ODE also runs with the step of "
      "the\n"
      "thesis, 100 ms, and the table shows how its robots then behave. Tables 5.3 (proximity sensors) and 5.4 (light\n"
      "and sound): robots at rest, compared with ray casts in ODE. docs/bench.md describes the tables.");
}

void add_lockstep_options(CommandLine line, BenchCommand& command) {
  bench::LockstepOptions& options = command.lockstep;
  std::vector<std::string> names;
  for (const auto& [name, placement] : bench::placements()) names.push_back(name);
  line.add_option("--robots", options.robots, "Numbers of robots, one row for each")
      .comma_separated()
      .check(whole_number(1, 10'000))
      .capture_default_str()
      .type_name("N[,N...]");
  line.add_option("--placement", command.placements,
                  "Controllers per process: all in one process, eight, or one (default: measure all three)")
      .comma_separated()
      .check(one_of(names))
      .type_name("WHERE[,WHERE...]");
  line.add_option("--seconds", options.seconds, "Wall time of each repetition, for each of Cohort and UDP, in seconds")
      .check(number_above_zero(1e4, "seconds"))
      .capture_default_str()
      .type_name("S");
  line.add_option("--repetitions", options.repetitions, "Number of repetitions; Cohort and UDP alternate")
      .check(whole_number(1, 1000))
      .capture_default_str()
      .type_name("N");
  line.add_flag("--own-thread{false}", options.inline_step,
                "Step clients on a separate thread, like 'cohort host' without --inline");
  const Option look_ahead =
      line.add_flag("--look-ahead", options.look_ahead,
                    "With controllers that take as long as physics, measure runs with and without a command delay");
  line.add_option("--json", command.json, "Write the results to this file as JSON").type_name("FILE");
  line.add_option("--svg", command.svg, "Draw the results to this file as SVG").type_name("FILE").excludes(look_ahead);
  line.footer(
      "Compares a server and its clients in lockstep over DDS with the same number of processes that exchange the "
      "same\n"
      "bytes over raw UDP. The two alternate. docs/bench.md describes the measurement.\n"
      "Example: cohort-bench lockstep --robots 8,128 --placement eights");
}

// Adds the options of the client processes that `lockstep` starts.
void add_client_options(CommandLine line, bench::BenchClient& client) {
  line.add_option("--robots", client.robots).comma_separated();
  line.add_option("--domain", client.domain);
  line.add_option("--work", client.work);
  line.add_flag("--inline", client.inline_step);
  line.add_option("--udp-port", client.udp.port);
  line.add_option("--number", client.udp.number);
  line.add_option("--command-bytes", client.udp.command_bytes);
}

void add_commands(CommandLine line, BenchCommand& command) {
  using What = BenchCommand::What;
  const auto add = [&](const char* name, const char* text, What what) {
    CommandLine sub = line.add_subcommand(name, text);
    sub.callback([&command, what] { command.what = what; });
    return sub;
  };
  add_thesis_options(
      add("thesis", "Repeat the benchmark tables of the 2005 thesis that Cohort continues", What::thesis), command);
  add_lockstep_options(
      add("lockstep", "Measure the overhead of the lockstep barrier compared with raw UDP", What::lockstep), command);
  CommandLine client = add("client", "", What::client);
  client.hide();
  add_client_options(client, command.client);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  outlive_readers();
  CommandLine line("Compare the performance of Cohort with that of other physics engines on the same scenes",
                   "cohort-bench");
  line.set_version(version_text, "Print the version and build information");
  line.set_help("Print this help and exit");
  BenchCommand command;
  add_scenes_options(line, command);
  add_commands(line, command);
  LogFlags flags;
  add_log_flags(line, flags);
  return run_program(line, flags, argc, argv,
                     [&](Log& log, const std::atomic<bool>& stop) { return measure(command, log, stop); });
}
