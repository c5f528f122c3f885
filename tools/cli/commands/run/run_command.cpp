// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "client_sdk/math/portable_math.hpp"
#include "server/core/text.hpp"
#include "server/core/thread_room.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/run/in_process.hpp"
#include "server/run/run_world.hpp"
#include "server/run/session_snapshot.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/run/run_flags.hpp"
#include "tools/cli/commands/run/run_refusals.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/cli/running/controller_ends.hpp"
#include "tools/cli/running/cpu_time.hpp"
#include "tools/cli/running/one_run.hpp"
#include "tools/cli/running/run_recording.hpp"
#include "tools/cli/running/seed_table.hpp"
#include "tools/cli/running/seeds.hpp"
#include "tools/cli/running/serving.hpp"
#include "tools/cli/running/side_by_side.hpp"
#include "tools/cli/running/summary_file.hpp"
#include "tools/cli/running/team_controllers.hpp"

namespace cohort::tool {
namespace {

using session::RunResult;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Returns whether the run has free-running ROS 2 nodes, which need real time.
bool has_free_nodes(const RunCommand& command, const description::Experiment& experiment) {
  return command.ros2 && std::ranges::any_of(experiment.teams, [&](const description::Team& team) {
           return experiment.ros2.of_team(team.name).sync == description::RosSync::free;
         });
}

// Returns the speed. People and free-running hardware can follow only real time.
double speed_of(const RunCommand& command, const description::Experiment& experiment) {
  const bool has_free = std::ranges::any_of(
      experiment.teams, [](const description::Team& team) { return team.policy.mode == description::Mode::free; });
  return command.speed.value_or(
      has_keyboard(experiment) || has_free || command.view || has_free_nodes(command, experiment) ? 1.0 : 0.0);
}

// Returns the interval between snapshots, at least one step; 0 for none.
std::chrono::nanoseconds keep_interval_of(const RunCommand& command, const description::Experiment& experiment) {
  if (command.keep_interval <= 0.0) return std::chrono::nanoseconds(0);
  return std::max(experiment.world.step, nanoseconds(command.keep_interval));
}

// Runs the controllers in this process. If one of them ends the process, `finish` is called with the result.
RunResult run_here(const description::Experiment& experiment, Simulation& simulation,
                   const std::vector<TeamController>& controllers, const session::RunOptions& options,
                   session::RunListener listener, const std::function<int(const RunResult&)>& finish, Log& log,
                   const std::atomic<bool>& stop) {
  ControllerEnds ends(log, {.exit_code = exit_failed, .crashes = true});
  listener.can_fail = [&](const auto& fail) {
    ends.finish_with([&finish, fail](const std::string& why) { return finish(fail(why)); });
  };
  std::vector<ControllerKind> teams;
  teams.reserve(controllers.size());
  for (const TeamController& controller : controllers) teams.push_back(controller.kind());
  return session::run_in_process(experiment, simulation, teams, options, listener, stop);
}

void warn_if_not_portable(Log& log) {
  std::string names;
  for (const std::string& name : functions_not_portable()) names += " " + name;
  if (!names.empty())
    log.warning(
        "the state hash may differ on another CPU: these functions of the C library are used instead of Cohort's:" +
        names);
}

std::size_t count_of_runs(const RunCommand& command) {
  return command.files.size() * std::max<std::size_t>(1, command.seeds.size()) * command.repeat;
}

// Returns whether the run shows a world or a model without an experiment in a browser.
bool is_world_looked_at(const RunCommand& command, const std::filesystem::path& file) {
  return command.view && parsing::kind_of_file(file) == parsing::FileKind::sdf;
}

using ReadFile = decltype(parsing::read_experiment_with_joint_motors);

description::Experiment read(const RunCommand& command, const std::filesystem::path& file, Log& log) {
  std::optional<std::chrono::nanoseconds> duration;
  if (command.duration) duration = nanoseconds(*command.duration);
  const bool is_looked_at = is_world_looked_at(command, file);
  if (is_looked_at && !duration && count_of_runs(command) == 1) duration = parsing::without_end;
  auto* const read_file =
      is_looked_at ? parsing::read_experiment_with_joint_motors : static_cast<ReadFile*>(parsing::read_experiment);
  const Stopwatch reading;
  description::Experiment experiment = read_file(file, command.seed, duration, installed_model_folders(),
                                                 xacro_of(command.runs_xacro), command.settings);
  set_recorded(experiment, command.record);
  if (!command.is_part) log.warnings(experiment.world.warnings);
  log.info(
      fmt::format("read {} and {}: {}, {}, {}, in {:.2f} s", file.string(), experiment.world.file.string(),
                  counted(experiment.world.instances.size(), "model"), counted(experiment.world.robots.size(), "robot"),
                  counted(experiment.teams.size(), "team"), reading.seconds()),
      {{"models", experiment.world.instances.size()},
       {"robots", experiment.world.robots.size()},
       {"teams", experiment.teams.size()},
       {"seconds", reading.seconds()}});
  return experiment;
}

using Snapshot = std::shared_ptr<const session::SessionSnapshot>;
using ExperimentPtr = std::shared_ptr<const description::Experiment>;

session::RunWorld build_world(const RunCommand& command, const ExperimentPtr& experiment, const Snapshot& from,
                              Log& log) {
  const unsigned threads = session::threads_for(*experiment, command.threads);
  const Stopwatch building;
  session::RunWorld world = session::build_world(experiment, threads, from.get());
  log.info(fmt::format("built the world for {} in {:.2f} s", counted(threads, "thread"), building.seconds()),
           {{"threads", threads}, {"seconds", building.seconds()}});
  return world;
}

// State that runs share, and that one run leaves to the next.
struct Runs {
  const RunCommand& command;
  std::vector<ExperimentPtr> experiments{};
  std::vector<TeamController> controllers{};
  Snapshot from{};
  session::RunWorld first{};
  std::optional<Serving> serving{};
  double cpu_before = 0.0;
  std::vector<SeedRow> rows{};  // with --seeds: the runs that have succeeded
};

Outputs outputs_of(const RunCommand& command, std::size_t number, std::size_t count) {
  return (command.seeds.empty() ? numbered : numbered_by_seed)(command.outputs, number, count);
}

void add_row(Runs& runs, SeedRow row, std::size_t count, Log& log) {
  log.notice(fmt::format("run {} of {}: {}, seed {}: {:.2f} s simulated in {:.2f} s, state hash {}", row.run, count,
                         row.experiment, row.seed, row.sim_time, row.wall, row.state_hash),
             {{"run", row.run}, {"seed", row.seed}, {"state_hash", row.state_hash}});
  runs.rows.push_back(std::move(row));
}

// Prints the table of all seeds, and writes it where it was asked for. Returns the exit code.
int end_table(const Runs& runs, int code, Log& log) {
  const RunCommand& command = runs.command;
  if (command.seeds.empty()) return code;
  if (!command.quiet && !runs.rows.empty()) show(seed_table(runs.rows));
  flush_output();
  if (command.outputs.csv.empty()) return code;
  try {
    write_file("the table", command.outputs.csv, seed_csv(runs.rows));
    return code;
  } catch (const std::exception& error) {
    log.error(text_of(error));
    return code == exit_ok ? exit_failed : code;
  }
}

// Runs a world, and the worlds that replace it after a reset or a loaded snapshot. Returns the exit code; sets
// `goes_on` to false if no further run should follow.
int run_one(Runs& runs, std::size_t number, std::size_t count, session::RunWorld world, Log& log,
            const std::atomic<bool>& stop, bool& goes_on) {
  const RunCommand& command = runs.command;
  const session::RunOptions options = {
      .speed = speed_of(command, *world.experiment),
      .state = command.paused || command.view_opens ? session::PlaybackState::paused : session::PlaybackState::playing,
      .from = runs.from,
      .keep_interval = keep_interval_of(command, *world.experiment),
      .needs_recording = command.record_or_stop};
  using enum recording::Beginning;
  OneRun one(command, outputs_of(command, number, count), log, stop);
  one.begin(*world.experiment, *world.simulation, runs.from ? restored : first);
  const auto finish = [&](const RunResult& result) {
    const double now = cpu_seconds();
    const double cpu = now - std::exchange(runs.cpu_before, now);
    const int code = one.finish(result, cpu);
    if (!command.seeds.empty() && code == exit_ok && result.end == RunResult::End::finished)
      add_row(runs, seed_row(number, *world.experiment, result, cpu), count, log);
    return code;
  };
  const auto finish_process = [&](const RunResult& result) { return end_table(runs, finish(result), log); };
  const RunResult result = session::run_with_resets(
      world, options, session::threads_for(*world.experiment, command.threads),
      [&](const session::RunWorld& now, const session::RunOptions& with) {
        return runs.serving
                   ? runs.serving->run(*now.experiment, *now.simulation, with, one.listener(), stop, number == count)
                   : run_here(*now.experiment, *now.simulation, runs.controllers, with, one.listener(), finish_process,
                              log, stop);
      },
      [&](const RunResult& ended, const session::RunWorld& next) {
        const bool is_reset = ended.end == RunResult::End::reset;
        log.notice(fmt::format("{} at tick {}: the run continues from tick {} with seed {}",
                               is_reset ? "reset" : "snapshot loaded", ended.ticks, next.simulation->tick(),
                               next.experiment->seed));
        one.begin(*next.experiment, *next.simulation, is_reset ? reset : restored);
      });
  goes_on = result.end == RunResult::End::finished;
  return finish(result);
}

// Returns the experiment of a run: all experiments in order, then again with the next seed, then all of it again.
ExperimentPtr experiment_of_run(const Runs& runs, std::size_t number) {
  const ExperimentPtr& experiment = runs.experiments[(number - 1) % runs.experiments.size()];
  const std::vector<std::uint64_t>& seeds = runs.command.seeds;
  if (seeds.empty()) return experiment;
  return session::with_seed(experiment, seeds[(number - 1) / runs.experiments.size() % seeds.size()]);
}

// Reports a limit of threads and processes. Writes the summary of the run that could not begin for it. Returns the exit
// code.
int end_for_thread_limit(const Runs& runs, std::size_t number, const std::exception& error, Log& log) {
  const RunCommand& command = runs.command;
  const ExperimentPtr experiment = experiment_of_run(runs, number);
  const std::filesystem::path summary = outputs_of(command, number, count_of_runs(command)).summary;
  RunResult result;
  result.end = RunResult::End::failed;
  result.error = text_of(error);
  result.robots = static_cast<std::uint32_t>(experiment->world.robots.size());
  log.error(result.error);
  if (!summary.empty()) write_summary(summary, *experiment, result, cpu_seconds() - runs.cpu_before);
  return exit_failed;
}

// Runs all experiments in order, until one does not finish. Returns the exit code.
int run_each(Runs& runs, Log& log, const std::atomic<bool>& stop) {
  const std::size_t count = count_of_runs(runs.command);
  int code = exit_ok;
  std::size_t number = 1;
  try {
    bool goes_on = true;
    for (; number <= count && code == exit_ok && goes_on; ++number) {
      const ExperimentPtr experiment = experiment_of_run(runs, number);
      if (count > 1 && runs.command.seeds.empty())
        log.notice(fmt::format("run {} of {}: {}, seed {}", number, count, experiment->name, experiment->seed));
      session::RunWorld world = runs.first.simulation != nullptr
                                    ? std::exchange(runs.first, {})
                                    : build_world(runs.command, experiment, runs.from, log);
      code = run_one(runs, number, count, std::move(world), log, stop, goes_on);
    }
  } catch (const std::exception& error) {
    if (is_thread_limit(error)) return end_for_thread_limit(runs, number, error, log);
    log.error(text_of(error));
    return exit_failed;
  }
  return code;
}

// Reads the snapshot from which the runs start, and takes its seed.
Snapshot snapshot_of(RunCommand& command) {
  if (command.from.empty()) return nullptr;
  auto snapshot = std::make_shared<session::SessionSnapshot>(session::read_snapshot(command.from));
  if (command.seed && *command.seed != snapshot->seed)
    throw std::invalid_argument(fmt::format("{} has seed {}, which conflicts with '--seed {}'", command.from.string(),
                                            snapshot->seed, *command.seed));
  command.seed = snapshot->seed;
  return snapshot;
}

// Runs experiments that have been read. `again` receives the command line that repeats the run if the page of its view
// asks for that.
int run_read(Runs& runs, Log& log, const std::atomic<bool>& stop, std::vector<std::string>& again) {
  const RunCommand& command = runs.command;
  const std::size_t count = count_of_runs(command);
  const bool in_process = command.controllers == Controllers::in_process;
  const description::Experiment& first = *runs.experiments.front();
  std::optional<ControllerEnds> ends_on_trial(std::in_place, log, ControllerEnds::Options{exit_usage, true});
  if (command.controllers != Controllers::external) runs.controllers = load_controllers(first);
  runs.first = build_world(command, runs.experiments.front(), runs.from, log);
  if (command.controllers != Controllers::external) try_controllers(first, *runs.first.simulation, runs.controllers);
  ends_on_trial.reset();
  if (!command.is_part) warn_if_not_portable(log);
  if (!command.seeds.empty())
    if (const unsigned jobs = jobs_for(command, first, count); jobs > 1) {
      runs.controllers.clear();
      runs.first = {};
      const int code = run_side_by_side(command, first, jobs, log, stop,
                                        [&](SeedRow row) { add_row(runs, std::move(row), count, log); });
      return end_table(runs, code, log);
    }

  if (!in_process) runs.serving.emplace(command, first, log);
  if (runs.serving && command.view) runs.serving->start_view(first, outputs_of(command, count, count).recording, stop);
  if (runs.serving) runs.serving->start_controllers(first, runs.controllers);
  const int code = end_table(runs, run_each(runs, log, stop), log);
  if (runs.serving && !stop) runs.serving->let_look(stop);
  if (runs.serving && !stop) again = runs.serving->command_line_to_run_again();
  return code;
}

int run(RunCommand command, Log& log, const std::atomic<bool>& stop, std::vector<std::string>& again) {
  Runs runs{command};
  if (command.jobs > 0 && command.seeds.empty()) throw std::invalid_argument("'--jobs' needs '--seeds'");
  runs.cpu_before = cpu_seconds();  // the shell that this process replaced may have had children
  for (std::filesystem::path& file : command.files) {
    file = experiment_called(file);
    // The page is on the loopback. With security its user needs the right to drive, which --control asks for.
    if (command.secure.empty() && is_world_looked_at(command, file)) command.view_controls = true;
  }
  if (!command.seeds.empty()) command.seed = command.seeds.front();
  const std::size_t count = count_of_runs(command);
  for (std::size_t number = 1; number <= count; ++number) check_writable(outputs_of(command, number, count));
  if (!command.seeds.empty() && !command.outputs.csv.empty()) check_writable("the table", command.outputs.csv);
  if (command.record.makes_rosbag2) check_rosbag2(command, count);
  const bool in_process = command.controllers == Controllers::in_process;
  if (in_process) refuse_what_needs_a_server(command);
  runs.from = snapshot_of(command);
  for (const std::filesystem::path& file : command.files) {
    runs.experiments.push_back(std::make_shared<description::Experiment>(read(command, file, log)));
    if (!in_process) refuse_rewind_without_snapshots(command, *runs.experiments.back());
    if (runs.from) session::expect_same_experiment(*runs.from, *runs.experiments.back());
  }
  if (in_process) refuse_keyboard(*runs.experiments.front());
  try {
    return run_read(runs, log, stop, again);
  } catch (const std::exception& error) {
    if (!is_thread_limit(error)) throw;
    return end_for_thread_limit(runs, 1, error, log);
  }
}

// Replaces this process by the program with a command line.
[[noreturn]] void become(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv("/proc/self/exe", arguments.data());
  throw std::system_error(errno, std::generic_category(), "cannot restart the program");
}

Subcommand running(CommandLine line, const std::shared_ptr<RunCommand>& command, const LogFlags& flags) {
  return {line, [command, &flags](Log& log, const std::atomic<bool>& stop) {
            command->quiet = flags.quiet;
            std::vector<std::string> again;
            const int code = run(*command, log, stop, again);
            if (!again.empty()) become(std::move(again));
            return code;
          }};
}

}  // namespace

Subcommand add_run(CommandLine app, LogFlags& flags) {
  static const std::map<std::string, Controllers> placements = {{"inprocess", Controllers::in_process},
                                                                {"process", Controllers::process},
                                                                {"per-robot", Controllers::per_robot},
                                                                {"external", Controllers::external}};
  const auto command = std::make_shared<RunCommand>();
  CommandLine line = app.add_subcommand("run", "Run an experiment and its controllers");
  line.add_option("FILE", command->files.emplace_back(),
                  "Experiment (YAML), name of an example, or a world or model, which is simulated without controllers")
      .required()
      .type_name("");
  add_run_options(line, *command, flags);
  line.add_option_function<std::string>(
          "--controllers",
          [&command = *command](const std::string& where) { command.controllers = placements.at(where); },
          "Processes of the controllers: one per team (process, the default), one per robot (per-robot), that of the "
          "server (inprocess), or started separately (external)")
      .check(one_of({"process", "per-robot", "inprocess", "external"}))
      .type_name("process|per-robot|inprocess|external");
  line.add_option("--jobs", command->jobs,
                  "With --seeds: number of runs at the same time, each in its own process; results do not depend on it "
                  "(default: depends on the available cores)")
      .check(whole_number(1, 1024))
      .type_name("N");
  line.add_flag("--is-part", command->is_part).hide();
  line.footer("Example: cohort run obstacle_avoidance --duration 10 --plot run.svg");
  return running(line, command, flags);
}

Subcommand add_serve(CommandLine app, LogFlags& flags) {
  const auto command = std::make_shared<RunCommand>();
  command->controllers = Controllers::external;
  CommandLine line =
      app.add_subcommand("serve", "Simulate an experiment's world for controllers that attach over the network");
  line.add_option("FILE", command->files,
                  "Experiments (YAML), names of examples, worlds or models, which run one after the other")
      .required()
      .type_name("");
  add_run_options(line, *command, flags);
  line.add_option("--network", command->network, "Address of the network interface to which clients connect")
      .envname("COHORT_NETWORK")
      .capture_default_str()
      .type_name("ADDRESS");
  line.footer("Example: cohort serve obstacle_avoidance --domain 7 --network 10.0.0.5");
  return running(line, command, flags);
}

}  // namespace cohort::tool
