#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

#include "client_sdk/math/portable_math.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/session/exchange.hpp"
#include "server/session/in_process.hpp"
#include "server/session/session_snapshot.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/installed_models.hpp"
#include "tools/cohort/output_file.hpp"
#include "tools/cohort/plot.hpp"
#include "tools/cohort/printed_table.hpp"
#include "tools/cohort/run_recording.hpp"
#include "tools/cohort/run_trace.hpp"
#include "tools/cohort/serving.hpp"
#include "tools/cohort/summary_file.hpp"
#include "tools/cohort/team_controllers.hpp"
#include "tools/cohort/terminal.hpp"
#include "tools/cohort/wording.hpp"

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
  return command.speed.value_or(has_keyboard(experiment) || has_free ? 1.0 : 0.0);
}

// Of several runs each has a file of its own: `summary.json` of the second is `summary-2.json`.
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number, std::size_t count) {
  if (file.empty() || count == 1) return file;
  return file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string());
}

void refuse_keyboard(const description::Experiment& experiment) {
  for (const description::Team& team : experiment.teams)
    if (team.controller == keyboard_controller)
      throw description::InputError({{experiment.file, team.controller_line, "team " + team.name,
                                      "people drive over DDS: run this without --controllers inprocess"}});
}

RunResult run_here(const description::Experiment& experiment, Simulation& simulation,
                   const std::vector<TeamController>& controllers, const session::RunOptions& options,
                   const session::RunListener& listener, const std::atomic<bool>& stop) {
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

// One experiment, with all that people see of it.
class OneRun {
 public:
  OneRun(const RunCommand& command, std::size_t number, std::size_t count, const description::Experiment& experiment,
         Simulation& simulation, Log& log)
      : command_(command),
        experiment_(experiment),
        log_(log),
        summary_(numbered(command.summary, number, count)),
        plot_(numbered(command.plot, number, count)),
        recording_(numbered(command.record.file, number, count)),
        csv_(numbered(command.csv, number, count)),
        own_controllers_(command.controllers != Controllers::external && !has_keyboard(experiment)),
        terminal_(log, {.quiet = command.quiet, .own_controllers = own_controllers_}) {
    if (!plot_.empty()) trace_.emplace(experiment.world, simulation, command.viewpoint);
    if (!recording_.empty()) {
      recorder_.emplace(recording_, experiment);
      recorder_->begin(experiment, simulation, recording::Beginning::first);
    }
    if (!experiment.prints.empty()) table_.emplace(experiment, simulation, csv_.empty() && !command.quiet);
  }

  session::RunListener listener() {
    session::RunListener listener = {
        .progress = [&](const session::Progress& progress) { terminal_.progress(progress); },
        .news = [&](const session::Event& event) { terminal_.event(event); },
        .boundary =
            [&] {
              if (trace_) trace_->boundary();
              if (table_) table_->boundary();
            },
    };
    if (recorder_) add_recorder(listener, *recorder_);
    return listener;
  }

  /// Prints and writes what was asked for. The exit code.
  int finish(const RunResult& result, double cpu) {
    terminal_.summary(result, cpu);
    const bool written = write_files(result, cpu);
    switch (result.end) {
      case RunResult::End::finished:
      case RunResult::End::shut_down: return written ? exit_ok : exit_failed;
      case RunResult::End::reset:
      case RunResult::End::restored: return exit_ok;  // another one follows
      case RunResult::End::interrupted: return exit_interrupted;
      case RunResult::End::failed:
        log_.error(fmt::format("the run ended at tick {}: {}", result.ticks, result.error), {{"tick", result.ticks}});
    }
    return exit_failed;
  }

 private:
  bool write_files(const RunResult& result, double cpu) {
    const auto try_to = [&](const auto& write) {
      try {
        write();
        return true;
      } catch (const std::exception& error) {
        log_.error(error.what());
        return false;
      }
    };
    bool written = close_recording(result);
    if (!summary_.empty()) written &= try_to([&] { write_summary(summary_, experiment_, result, cpu); });
    if (trace_)
      written &= try_to([&] {
        const PlotCaption caption = {experiment_.name, result.sim_time, result.state_hash};
        write_file("the plot", plot_, draw_plot(trace_->finish(), caption));
      });
    if (!csv_.empty())
      written &= try_to([&] { write_file("the table", csv_, table_ ? table_->text() : std::string()); });
    return written;
  }

  bool close_recording(const RunResult& result) {
    if (!recorder_) return true;
    recorder_->finish(word_of(result.end), result.end == RunResult::End::finished ? result.stop_reason : result.error);
    if (const std::uint64_t dropped = recorder_->dropped(); dropped > 0)
      log_.warning(
          fmt::format("{} poses and observations are not in {}: its disk was too slow. Commands and events are "
                      "all there; --record-poses and --record-observations ask for fewer",
                      dropped, recording_.string()),
          {{"dropped", dropped}});
    const std::optional<std::string> error = recorder_->error();
    if (error) log_.error("the recording ended before its run: " + *error);
    return !error;
  }

  const RunCommand& command_;
  const description::Experiment& experiment_;
  Log& log_;
  std::filesystem::path summary_, plot_, recording_, csv_;
  bool own_controllers_;
  Terminal terminal_;
  std::optional<recording::Recorder> recorder_;
  std::optional<TraceRecorder> trace_;
  std::optional<PrintedTable> table_;
};

description::Experiment read(const RunCommand& command, const std::filesystem::path& file, Log& log) {
  std::optional<std::chrono::nanoseconds> duration;
  if (command.duration)
    duration = std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(*command.duration));
  const Stopwatch reading;
  description::Experiment experiment =
      description::read_experiment(file, command.seed, duration, installed_model_folders());
  set_recorded(experiment, command.record);
  for (const description::Problem& warning : experiment.world.warnings) log.problem(LogLevel::warning, warning);
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

std::unique_ptr<Simulation> build(const RunCommand& command, const description::Experiment& experiment, Log& log) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const unsigned wanted = command.threads == 0 ? experiment.threads : command.threads;
  const unsigned threads = wanted == 0 ? cores : wanted;
  const Stopwatch building;
  auto simulation = std::make_unique<Simulation>(experiment, threads);
  log.info(fmt::format("built the world for {} in {:.2f} s", counted(threads, "thread"), building.seconds()),
           {{"threads", threads}, {"seconds", building.seconds()}});
  return simulation;
}

using Snapshot = std::shared_ptr<const session::SessionSnapshot>;

struct World {
  std::shared_ptr<const description::Experiment> experiment;
  std::unique_ptr<Simulation> simulation;
};

// A reset is a world that is built anew.
World build_world(const RunCommand& command, std::shared_ptr<const description::Experiment> experiment,
                  const Snapshot& from, Log& log) {
  World world{std::move(experiment), nullptr};
  world.simulation = build(command, *world.experiment, log);
  if (from) session::restore(*from, *world.simulation);
  return world;
}

// What a run is to be followed by. Throws if there is anything wrong with it.
World world_of(const session::NextRun& next, const RunCommand& command, const World& now, Log& log) {
  std::shared_ptr<const description::Experiment> experiment = now.experiment;
  if (next.seed != experiment->seed) {
    // From what was read before, whatever has become of the files.
    description::Experiment other =
        description::read_experiment(now.experiment->inputs, next.seed, now.experiment->duration);
    set_recorded(other, command.record);
    experiment = std::make_shared<description::Experiment>(std::move(other));
  }
  World world = build_world(command, std::move(experiment), next.snapshot, log);
  if (next.snapshot) {
    session::Exchange tried(*world.simulation);
    session::restore(*next.snapshot, tried);
  }
  return world;
}

// All that runs have in common, and what they leave to the next one.
struct Runs {
  const RunCommand& command;
  std::vector<std::shared_ptr<const description::Experiment>> experiments{};
  std::vector<TeamController> controllers{};
  Snapshot from{};
  World first{};
  std::optional<Serving> serving{};
  double cpu_before = 0.0;
};

// One, and those that whoever controls it puts in its place. The exit code; `goes_on` is false if no further one is to
// follow.
int run_one(Runs& runs, std::size_t number, std::size_t count, World world, Log& log, const std::atomic<bool>& stop,
            bool& goes_on) {
  const RunCommand& command = runs.command;
  session::RunOptions options = {.speed = speed_of(command, *world.experiment),
                                 .state = command.paused ? session::PlayState::paused : session::PlayState::playing,
                                 .from = runs.from};
  for (;;) {
    std::optional<World> next;
    options.prepare = [&](const session::NextRun& wanted) { next = world_of(wanted, command, world, log); };
    RunResult result;
    {
      OneRun one(command, number, count, *world.experiment, *world.simulation, log);
      result =
          runs.serving
              ? runs.serving->run(*world.experiment, *world.simulation, options, one.listener(), stop, number == count)
              : run_here(*world.experiment, *world.simulation, runs.controllers, options, one.listener(), stop);
      if (!result.next) {
        const double cpu = cpu_seconds();
        goes_on = result.end == RunResult::End::finished;
        return one.finish(result, cpu - std::exchange(runs.cpu_before, cpu));
      }
    }
    log.notice(fmt::format("{} at tick {}: goes on from tick {} with seed {}",
                           result.end == RunResult::End::reset ? "reset" : "another snapshot", result.ticks,
                           next->simulation->tick(), next->experiment->seed));
    world.simulation.reset();  // before what it was made of
    world = std::move(*next);
    options = {.speed = result.next->speed, .state = result.next->state, .from = result.next->snapshot};
  }
}

// One after the other, each as often as asked for, until one does not finish. The exit code.
int run_each(Runs& runs, Log& log, const std::atomic<bool>& stop) {
  const std::size_t count = runs.experiments.size() * runs.command.repeat;
  int code = exit_ok;
  try {
    bool goes_on = true;
    for (std::size_t number = 1; number <= count && code == exit_ok && goes_on; ++number) {
      const auto& experiment = runs.experiments[(number - 1) % runs.experiments.size()];
      if (count > 1) log.notice(fmt::format("run {} of {}: {}", number, count, experiment->name));
      World world = runs.first.simulation != nullptr ? std::exchange(runs.first, {})
                                                     : build_world(runs.command, experiment, runs.from, log);
      code = run_one(runs, number, count, std::move(world), log, stop, goes_on);
    }
  } catch (const std::exception& error) {
    log.error(error.what());
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

}  // namespace

int run(const RunCommand& asked, Log& log, const std::atomic<bool>& stop) {
  RunCommand command = asked;
  Runs runs{command};
  runs.cpu_before = cpu_seconds();  // a shell that became this process may have had children
  try {
    const std::size_t count = command.files.size() * command.repeat;
    for (std::size_t number = 1; number <= count; ++number) {
      if (!command.summary.empty()) check_writable("the summary", numbered(command.summary, number, count));
      if (!command.plot.empty()) check_writable("the plot", numbered(command.plot, number, count));
      if (!command.record.file.empty()) check_writable("the recording", numbered(command.record.file, number, count));
      if (!command.csv.empty()) check_writable("the table", numbered(command.csv, number, count));
    }
    const bool in_process = command.controllers == Controllers::in_process;
    if (in_process && command.paused)
      throw std::invalid_argument(
          "a run with its controllers in the server's process cannot be controlled: --paused "
          "goes with other --controllers");
    runs.from = snapshot_of(command);
    for (const std::filesystem::path& file : command.files) {
      runs.experiments.push_back(std::make_shared<description::Experiment>(read(command, file, log)));
      if (runs.from) session::expect_same_experiment(*runs.from, *runs.experiments.back());
    }
    const description::Experiment& first = *runs.experiments.front();
    if (in_process) refuse_keyboard(first);
    if (command.controllers != Controllers::external) runs.controllers = load_controllers(first);
    runs.first = build_world(command, runs.experiments.front(), runs.from, log);
    if (command.controllers != Controllers::external) try_controllers(first, *runs.first.simulation, runs.controllers);
    warn_if_not_portable(log);

    if (!in_process) runs.serving.emplace(command, first, log);
    if (runs.serving) runs.serving->start_controllers(first, runs.controllers);
    return run_each(runs, log, stop);
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
