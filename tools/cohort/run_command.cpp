#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <memory>
#include <thread>

#include "client_sdk/math/portable_math.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/session/in_process.hpp"
#include "server/session/server.hpp"
#include "tools/cohort/children.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/controller_processes.hpp"
#include "tools/cohort/installed_models.hpp"
#include "tools/cohort/output_file.hpp"
#include "tools/cohort/plot.hpp"
#include "tools/cohort/printed_table.hpp"
#include "tools/cohort/run_trace.hpp"
#include "tools/cohort/summary_file.hpp"
#include "tools/cohort/team_controllers.hpp"
#include "tools/cohort/terminal.hpp"
#include "tools/cohort/wording.hpp"

namespace cohort::tool {
namespace {

using session::RunResult;

// Domains that a run picks from for itself and the controllers that it starts.
constexpr std::uint32_t first_own_domain = 1;
constexpr std::uint32_t own_domain_count = 59;

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

struct Served {
  wire::Participant participant;
  std::uint32_t domain;
};

// Outsiders need to know the domain: it is the one given, or 0. Nobody but our own children needs to know ours: it is
// any free one, so that several runs on one machine do not meet.
Served open_domain(const RunCommand& command, bool has_outsiders) {
  if (command.domain || has_outsiders) {
    const std::uint32_t domain = command.domain.value_or(0);
    return {wire::Participant::server(domain, command.network), domain};
  }
  const auto start = static_cast<std::uint32_t>(getpid());
  for (std::uint32_t i = 0;; ++i) {
    const std::uint32_t domain = first_own_domain + (start + i) % own_domain_count;
    try {
      return {wire::Participant::server(domain, command.network), domain};
    } catch (const wire::DomainTaken&) {
      if (i + 1 == own_domain_count) throw;
    } catch (const wire::WireError& error) {
      throw wire::WireError(std::string(error.what()) + ". --controllers inprocess needs no network");
    }
  }
}

// People cannot follow what is faster than life.
double speed_of(const RunCommand& command, const description::Experiment& experiment) {
  return command.speed.value_or(has_keyboard(experiment) ? 1.0 : 0.0);
}

void refuse_keyboard(const description::Experiment& experiment) {
  for (const description::Team& team : experiment.teams)
    if (team.controller == keyboard_controller)
      throw description::InputError({{experiment.file, team.controller_line, "team " + team.name,
                                      "people drive over DDS: run this without --controllers inprocess"}});
}

RunResult run_over_dds(const RunCommand& command, const description::Experiment& experiment, Simulation& simulation,
                       const std::vector<TeamController>& controllers, Log& log, const session::RunListener& listener,
                       const std::atomic<bool>& stop, bool& has_begun) {
  Served served = open_domain(command, command.controllers == Controllers::external || has_keyboard(experiment));
  Children* own_controllers = nullptr;
  session::RunListener own_listener = listener;
  own_listener.ending = [&] {
    if (own_controllers != nullptr) own_controllers->stop_restarting();
  };
  session::Server server(experiment, simulation, served.participant, {speed_of(command, experiment)}, own_listener);
  const bool external = command.controllers == Controllers::external;
  const std::string serving = fmt::format("serving {} on {}, domain {}", counted(simulation.robot_count(), "robot"),
                                          command.network, served.domain);
  const LogFields where = {{"address", command.network}, {"domain", served.domain}};
  if (external) {
    log.notice(serving, where);
    has_begun = true;
    return server.run(stop);
  }
  log.info(serving, where);
  for (const description::Team& team : experiment.teams)
    if (team.controller == keyboard_controller)
      log.notice(fmt::format("to drive team '{}', in another terminal: cohort teleop --robots {} --domain {}",
                             team.name, selectors_of(team.robots), served.domain));
  const bool per_robot = command.controllers == Controllers::per_robot;
  Children children(controller_processes(experiment, controllers, per_robot, served.domain, log),
                    listener_of_controllers(server, log));
  own_controllers = &children;
  has_begun = true;
  RunResult result = server.run(stop);
  children.let_finish();
  return result;
}

RunResult run_here(const RunCommand& command, const description::Experiment& experiment, Simulation& simulation,
                   const std::vector<TeamController>& controllers, const session::RunListener& listener,
                   const std::atomic<bool>& stop) {
  std::vector<ControllerKind> teams;
  teams.reserve(controllers.size());
  for (const TeamController& controller : controllers) teams.push_back(controller.kind());
  return session::run_in_process(experiment, simulation, teams, {speed_of(command, experiment)}, listener, stop);
}

void warn_if_not_portable(Log& log) {
  std::string names;
  for (const std::string& name : functions_not_portable()) names += " " + name;
  if (!names.empty())
    log.warning("this run's hash may differ on another CPU: the C library's" + names + " are in use instead of ours");
}

// Whether all that was asked for is written.
bool write_files(const RunCommand& command, const description::Experiment& experiment, const RunResult& result,
                 double cpu, std::optional<TraceRecorder>& recorder, const std::optional<PrintedTable>& table,
                 Log& log) {
  const auto try_to = [&](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      log.error(error.what());
      return false;
    }
  };
  bool written = true;
  if (!command.summary.empty()) written &= try_to([&] { write_summary(command.summary, result, cpu); });
  if (recorder)
    written &= try_to([&] {
      const PlotCaption caption = {experiment.name, result.sim_time, result.state_hash};
      write_file("the plot", command.plot, draw_plot(recorder->finish(), caption));
    });
  if (!command.csv.empty())
    written &= try_to([&] { write_file("the table", command.csv, table ? table->text() : std::string()); });
  return written;
}

}  // namespace

int run(const RunCommand& command, Log& log, const std::atomic<bool>& stop) {
  const double cpu_before = cpu_seconds();  // a shell that became this process may have had children
  bool has_begun = false;
  try {
    if (!command.summary.empty()) check_writable("the summary", command.summary);
    if (!command.plot.empty()) check_writable("the plot", command.plot);
    if (!command.csv.empty()) check_writable("the table", command.csv);
    std::optional<std::chrono::nanoseconds> duration;
    if (command.duration)
      duration = std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(*command.duration));
    Stopwatch reading;
    const description::Experiment experiment =
        description::read_experiment(command.file, command.seed, duration, installed_model_folders());
    for (const description::Problem& warning : experiment.world.warnings) log.problem(LogLevel::warning, warning);
    log.info(fmt::format("read {} and {}: {}, {}, {}, in {:.2f} s", command.file.string(),
                         experiment.world.file.string(), counted(experiment.world.instances.size(), "model"),
                         counted(experiment.world.robots.size(), "robot"), counted(experiment.teams.size(), "team"),
                         reading.seconds()),
             {{"models", experiment.world.instances.size()},
              {"robots", experiment.world.robots.size()},
              {"teams", experiment.teams.size()},
              {"seconds", reading.seconds()}});

    if (command.controllers == Controllers::in_process) refuse_keyboard(experiment);
    std::vector<TeamController> controllers;
    if (command.controllers != Controllers::external) controllers = load_controllers(experiment);
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    const unsigned wanted = command.threads == 0 ? experiment.threads : command.threads;
    const unsigned threads = wanted == 0 ? cores : wanted;
    Stopwatch building;
    Simulation simulation(experiment, threads);
    log.info(fmt::format("built the world for {} in {:.2f} s", counted(threads, "thread"), building.seconds()),
             {{"threads", threads}, {"seconds", building.seconds()}});
    if (command.controllers != Controllers::external) try_controllers(experiment, simulation, controllers);
    warn_if_not_portable(log);

    std::optional<TraceRecorder> recorder;
    if (!command.plot.empty()) recorder.emplace(experiment.world, simulation, command.viewpoint);
    const bool own_controllers = command.controllers != Controllers::external && !has_keyboard(experiment);
    std::optional<PrintedTable> table;
    if (!experiment.prints.empty()) table.emplace(experiment, simulation, command.csv.empty() && !command.quiet);
    Terminal terminal(log, {.quiet = command.quiet, .own_controllers = own_controllers});
    const session::RunListener listener = {
        .progress = [&](const session::Progress& progress) { terminal.progress(progress); },
        .event = [&](const session::Event& event) { terminal.event(event); },
        .boundary =
            [&] {
              if (recorder) recorder->boundary();
              if (table) table->boundary();
            },
    };
    has_begun = command.controllers == Controllers::in_process;
    const RunResult result =
        has_begun ? run_here(command, experiment, simulation, controllers, listener, stop)
                  : run_over_dds(command, experiment, simulation, controllers, log, listener, stop, has_begun);
    const double cpu = cpu_seconds() - cpu_before;
    terminal.summary(result, cpu);
    const bool written = write_files(command, experiment, result, cpu, recorder, table, log);
    switch (result.end) {
      case RunResult::End::finished: return written ? exit_ok : exit_failed;
      case RunResult::End::interrupted: return exit_interrupted;
      case RunResult::End::failed:
        log.error(fmt::format("the run ended at tick {}: {}", result.ticks, result.error), {{"tick", result.ticks}});
    }
    return exit_failed;
  } catch (const description::InputError& error) {
    log.problems(error);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return has_begun ? exit_failed : exit_usage;
}

}  // namespace cohort::tool
