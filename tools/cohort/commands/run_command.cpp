#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "client_sdk/math/portable_math.hpp"
#include "server/core/text.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/in_process.hpp"
#include "server/run/run_world.hpp"
#include "server/run/session_snapshot.hpp"
#include "tools/cohort/cli/installed_files.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/cli/wording.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/shared_options.hpp"
#include "tools/cohort/running/controller_ends.hpp"
#include "tools/cohort/running/one_run.hpp"
#include "tools/cohort/running/run_recording.hpp"
#include "tools/cohort/running/seeds.hpp"
#include "tools/cohort/running/serving.hpp"
#include "tools/cohort/running/team_controllers.hpp"

namespace cohort::tool {
namespace {

using session::RunResult;

double cpu_seconds() {
  double total = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& part : {usage.ru_utime, usage.ru_stime})
      total += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
  }
  return total;
}

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// People cannot follow what is faster than life, nor can hardware, which nobody waits for.
double speed_of(const RunCommand& command, const description::Experiment& experiment) {
  const bool has_free = std::ranges::any_of(
      experiment.teams, [](const description::Team& team) { return team.policy.mode == description::Mode::free; });
  return command.speed.value_or(has_keyboard(experiment) || has_free || command.view ? 1.0 : 0.0);
}

// At least one step.
std::chrono::nanoseconds keep_interval_of(const RunCommand& command, const description::Experiment& experiment) {
  if (command.keep_interval <= 0.0) return std::chrono::nanoseconds(0);
  return std::max(experiment.world.step, nanoseconds(command.keep_interval));
}

void refuse_keyboard(const description::Experiment& experiment) {
  for (const description::Team& team : experiment.teams)
    if (team.controller == keyboard_controller)
      throw description::InputError({{experiment.file, team.controller_line, "team " + team.name,
                                      "people drive over DDS: run this without --controllers inprocess"}});
}

// With its controllers in this process. If one of them ends the process, `finish` is called with the result.
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
    log.warning("this run's hash may differ on another CPU: the C library's" + names + " are in use instead of ours");
}

void refuse_what_needs_a_server(const RunCommand& command) {
  const auto refuse = [](const std::string& option) {
    throw std::invalid_argument("nobody can reach a run whose controllers are in the server's process: " + option +
                                " goes with other --controllers");
  };
  if (command.paused) refuse("--paused");
  if (command.keep_interval > 0.0) refuse("--keep-snapshots");
  if (command.view) refuse("--view");
}

void refuse_rewind_without_snapshots(const RunCommand& command, const description::Experiment& experiment) {
  if (command.keep_interval > 0.0) return;
  for (const description::Team& team : experiment.teams)
    if (team.policy.on_lost == description::OnLost::rewind)
      throw description::InputError(
          {{experiment.file, 0, "team " + team.name,
            "on_lost: rewind needs snapshots to go back to; add --keep-snapshots 10, for one every 10 s"}});
}

description::Experiment read(const RunCommand& command, const std::filesystem::path& file, Log& log) {
  std::optional<std::chrono::nanoseconds> duration;
  if (command.duration) duration = nanoseconds(*command.duration);
  const Stopwatch reading;
  description::Experiment experiment =
      parsing::read_experiment(file, command.seed, duration, installed_model_folders(), xacro_of(command.runs_xacro));
  set_recorded(experiment, command.record);
  log.warnings(experiment.world.warnings);
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

// All that runs have in common, and what they leave to the next one.
struct Runs {
  const RunCommand& command;
  std::vector<ExperimentPtr> experiments{};
  std::vector<TeamController> controllers{};
  Snapshot from{};
  session::RunWorld first{};
  std::optional<Serving> serving{};
  double cpu_before = 0.0;
};

// Runs a world, and those that take its place. Returns the exit code; `goes_on` is false if no further run is to
// follow.
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
  OneRun one(command, numbered(command.outputs, number, count), log, stop);
  one.begin(*world.experiment, *world.simulation, runs.from ? restored : first);
  const auto finish = [&](const RunResult& result) {
    const double cpu = cpu_seconds();
    return one.finish(result, cpu - std::exchange(runs.cpu_before, cpu));
  };
  const RunResult result = session::run_with_resets(
      world, options, session::threads_for(*world.experiment, command.threads),
      [&](const session::RunWorld& now, const session::RunOptions& with) {
        return runs.serving
                   ? runs.serving->run(*now.experiment, *now.simulation, with, one.listener(), stop, number == count)
                   : run_here(*now.experiment, *now.simulation, runs.controllers, with, one.listener(), finish, log,
                              stop);
      },
      [&](const RunResult& ended, const session::RunWorld& next) {
        const bool is_reset = ended.end == RunResult::End::reset;
        log.notice(fmt::format("{} at tick {}: goes on from tick {} with seed {}",
                               is_reset ? "reset" : "another snapshot", ended.ticks, next.simulation->tick(),
                               next.experiment->seed));
        one.begin(*next.experiment, *next.simulation, is_reset ? reset : restored);
      });
  goes_on = result.end == RunResult::End::finished;
  return finish(result);
}

std::size_t count_of_runs(const RunCommand& command) {
  return command.files.size() * std::max<std::size_t>(1, command.seeds.size()) * command.repeat;
}

// The experiments one after the other, then with the next seed, and all of it again.
ExperimentPtr experiment_of_run(const Runs& runs, std::size_t number) {
  const ExperimentPtr& experiment = runs.experiments[(number - 1) % runs.experiments.size()];
  const std::vector<std::uint64_t>& seeds = runs.command.seeds;
  if (seeds.empty()) return experiment;
  return session::with_seed(experiment, seeds[(number - 1) / runs.experiments.size() % seeds.size()]);
}

// One after the other, each as often as asked for, until one does not finish. The exit code.
int run_each(Runs& runs, Log& log, const std::atomic<bool>& stop) {
  const std::size_t count = count_of_runs(runs.command);
  int code = exit_ok;
  try {
    bool goes_on = true;
    for (std::size_t number = 1; number <= count && code == exit_ok && goes_on; ++number) {
      const ExperimentPtr experiment = experiment_of_run(runs, number);
      if (count > 1)
        log.notice(fmt::format("run {} of {}: {}, seed {}", number, count, experiment->name, experiment->seed));
      session::RunWorld world = runs.first.simulation != nullptr
                                    ? std::exchange(runs.first, {})
                                    : build_world(runs.command, experiment, runs.from, log);
      code = run_one(runs, number, count, std::move(world), log, stop, goes_on);
    }
  } catch (const std::exception& error) {
    log.error(text_of(error));
    return exit_failed;
  }
  return code;
}

// Where the runs begin, and with which seed.
Snapshot snapshot_of(RunCommand& command) {
  if (command.from.empty()) return nullptr;
  auto snapshot = std::make_shared<session::SessionSnapshot>(session::read_snapshot(command.from));
  if (command.seed && *command.seed != snapshot->seed)
    throw std::invalid_argument(
        fmt::format("{} has seed {}, and --seed says {}", command.from.string(), snapshot->seed, *command.seed));
  command.seed = snapshot->seed;
  return snapshot;
}

int run(RunCommand command, Log& log, const std::atomic<bool>& stop) {
  Runs runs{command};
  runs.cpu_before = cpu_seconds();  // a shell that became this process may have had children
  for (std::filesystem::path& file : command.files) file = experiment_called(file);
  if (!command.seeds.empty()) command.seed = command.seeds.front();
  const std::size_t count = count_of_runs(command);
  for (std::size_t number = 1; number <= count; ++number) check_writable(numbered(command.outputs, number, count));
  const bool in_process = command.controllers == Controllers::in_process;
  if (in_process) refuse_what_needs_a_server(command);
  runs.from = snapshot_of(command);
  for (const std::filesystem::path& file : command.files) {
    runs.experiments.push_back(std::make_shared<description::Experiment>(read(command, file, log)));
    if (!in_process) refuse_rewind_without_snapshots(command, *runs.experiments.back());
    if (runs.from) session::expect_same_experiment(*runs.from, *runs.experiments.back());
  }
  const description::Experiment& first = *runs.experiments.front();
  if (in_process) refuse_keyboard(first);
  std::optional<ControllerEnds> ends_on_trial(std::in_place, log, ControllerEnds::Options{exit_usage, true});
  if (command.controllers != Controllers::external) runs.controllers = load_controllers(first);
  runs.first = build_world(command, runs.experiments.front(), runs.from, log);
  if (command.controllers != Controllers::external) try_controllers(first, *runs.first.simulation, runs.controllers);
  ends_on_trial.reset();
  warn_if_not_portable(log);

  if (!in_process) runs.serving.emplace(command, first, log);
  if (runs.serving && command.view) runs.serving->start_view(first, numbered(command.outputs, count, count).recording);
  if (runs.serving) runs.serving->start_controllers(first, runs.controllers);
  const int code = run_each(runs, log, stop);
  if (runs.serving && !stop) runs.serving->let_look(stop);
  return code;
}

std::vector<std::uint64_t> seeds_or_usage_error(const std::string& text) {
  try {
    return parse_seeds(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--seeds: ") + error.what());
  }
}

void add_run_options(CommandLine line, RunCommand& command, LogFlags& flags) {
  line.add_option("--repeat", command.repeat,
                  "How often to run it, the world built anew each time, the controllers attached")
      .check(whole_number(1, 1'000'000))
      .capture_default_str()
      .type_name("N");
  line.add_option("--threads", command.threads,
                  "Threads that step the world, with the same results (default: the cores that it may use)")
      .check(whole_number(1, 1024))
      .type_name("N");
  line.add_option("--duration", command.duration, "Simulated seconds, instead of the experiment's")
      .check(number_above_zero(most_seconds))
      .type_name("S");
  const Option seed = line.add_option("--seed", command.seed, "Seed, instead of the experiment's")
                          .check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
                          .type_name("N");
  const Option seeds =
      line.add_option_function<std::string>(
              "--seeds", [&command](const std::string& text) { command.seeds = seeds_or_usage_error(text); },
              "Run it once with each of these seeds, such as 1..30 or 4,8,15")
          .excludes(seed)
          .type_name("A..B[,...]");
  line.add_option_function<std::string>(
          "--speed",
          [&command](const std::string& speed) { command.speed = speed == "max" ? 0.0 : *parse_real(speed); },
          "Simulated seconds per second at the most (default: max, or 1 if people drive or look)")
      .check(max_or_number_above_zero(1e9))
      .type_name("max|X");
  line.add_option("--summary", command.outputs.summary, "Write the summary to this file as JSON").type_name("FILE");
  line.add_option("--plot", command.outputs.plot, "Draw arena, paths and contacts to this file as SVG")
      .type_name("FILE");
  add_viewpoint_option(line, "--plot-view", "Of the plot", command.outputs.viewpoint);
  line.add_option("--csv", command.outputs.csv, "Write what the experiment prints to this file as CSV")
      .type_name("FILE");
  const Option record =
      line.add_option("--record", command.outputs.recording, "Record the run to this file (MCAP)").type_name("FILE");
  line.add_flag("--record-or-stop", command.record_or_stop,
                "End the run when it cannot be recorded any more, with the exit code 4")
      .needs(record);
  add_recorded_options(line, command.record, "--record-");
  const Option view = line.add_flag("--view", command.view, "Show it in a browser, as 'cohort view' does");
  line.add_flag("--control", command.view_controls, "With --view: let whoever looks control it").needs(view);
  line.add_flag("--open", command.view_opens, "With --view: open it in a browser, and begin when it is seen there")
      .needs(view);
  line.add_flag("--paused", command.paused, "Begin paused, until 'cohort ctl resume' or 'step'");
  line.add_option("--keep-snapshots", command.keep_interval,
                  "Simulated seconds between snapshots in memory, for 'cohort ctl back' (default: none)")
      .check(number_above_zero(most_seconds))
      .type_name("S");
  line.add_option("--from", command.from, "Go on from this snapshot of 'cohort ctl save'")
      .excludes(seeds)
      .type_name("FILE");
  add_reading_options(line, command.runs_xacro);
  add_domain_option(line, command.domains,
                    "DDS domains to serve (default: free ones, or 0 if others start controllers)");
  add_secure_option(line, command.secure, "Folder of 'cohort security': nobody else gets in (default: $COHORT_SECURE)");
  add_log_flags(line, flags);
  line.add_flag("--quiet", flags.quiet, "Print errors only");
}

Subcommand running(CommandLine line, const std::shared_ptr<RunCommand>& command, const LogFlags& flags) {
  return {line, [command, &flags](Log& log, const std::atomic<bool>& stop) {
            command->quiet = flags.quiet;
            return run(*command, log, stop);
          }};
}

}  // namespace

Subcommand add_run(CommandLine app, LogFlags& flags) {
  static const std::map<std::string, Controllers> placements = {{"inprocess", Controllers::in_process},
                                                                {"process", Controllers::process},
                                                                {"per-robot", Controllers::per_robot},
                                                                {"external", Controllers::external}};
  const auto command = std::make_shared<RunCommand>();
  CommandLine line = app.add_subcommand("run", "Run an experiment with its controllers");
  line.add_option("FILE", command->files.emplace_back(),
                  "Experiment (YAML) or the name of an example; or a world or a model, which runs without controllers")
      .required()
      .type_name("");
  add_run_options(line, *command, flags);
  line.add_option_function<std::string>(
          "--controllers",
          [&command = *command](const std::string& where) { command.controllers = placements.at(where); },
          "process for each team (the default), per-robot, inprocess with the server, or external")
      .check(one_of({"process", "per-robot", "inprocess", "external"}))
      .type_name("process|per-robot|inprocess|external");
  line.footer("Example: cohort run obstacle_avoidance --duration 10 --plot run.svg");
  return running(line, command, flags);
}

Subcommand add_serve(CommandLine app, LogFlags& flags) {
  const auto command = std::make_shared<RunCommand>();
  command->controllers = Controllers::external;
  CommandLine line = app.add_subcommand("serve", "Run an experiment alone and wait for controllers to attach");
  line.add_option("FILE", command->files,
                  "Experiments (YAML), names of examples, worlds or models, run one after the other")
      .required()
      .type_name("");
  add_run_options(line, *command, flags);
  line.add_option("--network", command->network, "Address of the interface to serve on")
      .envname("COHORT_NETWORK")
      .capture_default_str()
      .type_name("ADDRESS");
  line.footer("Example: cohort serve obstacle_avoidance --domain 7 --network 10.0.0.5");
  return running(line, command, flags);
}

}  // namespace cohort::tool
