#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <thread>

#include "server/core/portable_math.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/session/in_process.hpp"
#include "server/session/server.hpp"
#include "tools/cohort/children.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/controller_plugins.hpp"
#include "tools/cohort/output_file.hpp"
#include "tools/cohort/plot.hpp"
#include "tools/cohort/run_trace.hpp"
#include "tools/cohort/summary_file.hpp"
#include "tools/cohort/terminal.hpp"

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

struct Served {
  wire::Participant participant;
  std::uint32_t domain;
};

// Outsiders need to know the domain: it is the one given, or 0. Nobody but our own children needs to know ours: it is
// any free one, so that several runs on one machine do not meet.
Served open_domain(const RunCommand& command) {
  if (command.domain || command.controllers == Controllers::external) {
    const std::uint32_t domain = command.domain.value_or(0);
    return {wire::Participant::server(domain, command.network), domain};
  }
  const std::uint32_t start = static_cast<std::uint32_t>(getpid());
  for (std::uint32_t i = 0;; ++i) {
    const std::uint32_t domain = first_own_domain + (start + i) % own_domain_count;
    try {
      return {wire::Participant::server(domain, command.network), domain};
    } catch (const wire::DomainTaken&) {
      if (i + 1 == own_domain_count) throw;
    }
  }
}

// Runs of ids, as short as they can be said.
std::string selectors_of(const std::vector<std::uint32_t>& robots) {
  std::string selectors;
  for (std::size_t begin = 0, end = 0; begin < robots.size(); begin = end) {
    for (end = begin + 1; end < robots.size() && robots[end] == robots[end - 1] + 1;) ++end;
    const std::string range =
        end - begin == 1 ? fmt::format("{}", robots[begin]) : fmt::format("{}..{}", robots[begin], robots[end - 1]);
    selectors += (begin == 0 ? "" : ",") + range;
  }
  return selectors;
}

std::vector<Children::Command> controller_commands(const description::Experiment& experiment,
                                                   const std::vector<LoadedPlugin>& plugins, bool per_robot,
                                                   std::uint32_t domain) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<Children::Command> commands;
  for (std::size_t i = 0; i < experiment.teams.size(); ++i) {
    const description::Team& team = experiment.teams[i];
    const auto add = [&](const std::vector<std::uint32_t>& robots) {
      Children::Command command;
      command.arguments = {program,     "host",     plugins[i].path(),     "--robots", selectors_of(robots), "--server",
                           "127.0.0.1", "--domain", std::to_string(domain)};
      const std::string more = robots.size() == 1 ? "" : fmt::format(" and {} more", robots.size() - 1);
      command.name = fmt::format("team '{}' ({}{})", team.name, experiment.world.robot(robots.front()).name, more);
      command.restarts = team.restart != description::Restart::never;
      commands.push_back(std::move(command));
    };
    if (!per_robot && !team.robots.empty()) add(team.robots);
    if (per_robot)
      for (const std::uint32_t robot : team.robots) add({robot});
  }
  return commands;
}

Children::Listener listen_to_children(session::Server& server) {
  Children::Listener listener;
  listener.restarted =
      listener.killed = [](const Children::Command&, const std::string& text) { spdlog::warn("{}", text); };
  listener.gave_up = [&](const std::string& text) { server.fail(text); };
  return listener;
}

RunResult run_over_dds(const RunCommand& command, const description::Experiment& experiment, Simulation& simulation,
                       const std::vector<LoadedPlugin>& plugins, Terminal& terminal,
                       const session::RunListener& listener, const std::atomic<bool>& stop) {
  Served served = open_domain(command);
  Children* own_controllers = nullptr;
  session::RunListener own_listener = listener;
  own_listener.ending = [&] {
    if (own_controllers != nullptr) own_controllers->stop_restarting();
  };
  session::Server server(experiment, simulation, served.participant, {command.speed}, own_listener);
  if (command.controllers == Controllers::external) {
    terminal.say(
        fmt::format("serving {} robots on {}, domain {}", simulation.robot_count(), command.network, served.domain));
    return server.run(stop);
  }
  const bool per_robot = command.controllers == Controllers::per_robot;
  Children children(controller_commands(experiment, plugins, per_robot, served.domain), listen_to_children(server));
  own_controllers = &children;
  RunResult result = server.run(stop);
  children.let_finish();
  return result;
}

RunResult run_here(const RunCommand& command, const description::Experiment& experiment, Simulation& simulation,
                   const std::vector<LoadedPlugin>& plugins, const session::RunListener& listener,
                   const std::atomic<bool>& stop) {
  std::vector<Plugin> teams;
  for (const LoadedPlugin& plugin : plugins) teams.push_back(plugin.plugin());
  return session::run_in_process(experiment, simulation, teams, {command.speed}, listener, stop);
}

void warn_if_not_portable() {
  std::string names;
  for (const std::string& name : functions_not_portable()) names += " " + name;
  if (!names.empty())
    spdlog::warn("this run's hash may differ on another CPU: the C library's{} are in use instead of ours", names);
}

// Whether all that was asked for is written.
bool write_files(const RunCommand& command, const description::Experiment& experiment, const RunResult& result,
                 double cpu, std::optional<TraceRecorder>& recorder) {
  const auto try_to = [](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      std::cerr << "cohort: " << error.what() << "\n";
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
  return written;
}

}  // namespace

int run(const RunCommand& command, const std::atomic<bool>& stop) {
  const double cpu_before = cpu_seconds();  // a shell that became this process may have had children
  try {
    if (!command.summary.empty()) check_writable("the summary", command.summary);
    if (!command.plot.empty()) check_writable("the plot", command.plot);
    std::optional<std::chrono::nanoseconds> duration;
    if (command.duration)
      duration = std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(*command.duration));
    const description::Experiment experiment = description::read_experiment(command.file, command.seed, duration);
    for (const description::Problem& warning : experiment.world.warnings) spdlog::warn("{}", warning.text());

    std::vector<LoadedPlugin> plugins;
    if (command.controllers != Controllers::external) plugins = load_controllers(experiment);
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    Simulation simulation(experiment, command.threads == 0 ? cores : command.threads);
    warn_if_not_portable();

    std::optional<TraceRecorder> recorder;
    if (!command.plot.empty()) recorder.emplace(experiment.world, simulation);
    Terminal terminal(command.quiet);
    const session::RunListener listener = {
        .progress = [&](const session::Progress& progress) { terminal.progress(progress); },
        .event = [&](const session::Event& event) { terminal.event(event); },
        .boundary = recorder ? std::function<void()>([&] { recorder->boundary(); }) : nullptr,
    };
    const RunResult result = command.controllers == Controllers::in_process
                                 ? run_here(command, experiment, simulation, plugins, listener, stop)
                                 : run_over_dds(command, experiment, simulation, plugins, terminal, listener, stop);
    const double cpu = cpu_seconds() - cpu_before;
    terminal.summary(result, cpu);
    const bool written = write_files(command, experiment, result, cpu, recorder);
    switch (result.end) {
      case RunResult::End::finished: return written ? exit_ok : exit_failed;
      case RunResult::End::interrupted: return exit_interrupted;
      case RunResult::End::failed: spdlog::error("the run ended at tick {}: {}", result.ticks, result.error);
    }
    return exit_failed;
  } catch (const description::InputError& error) {
    std::cerr << error.what() << "\n";
  } catch (const std::exception& error) {
    std::cerr << "cohort: " << error.what() << "\n";
  }
  return exit_usage;
}

}  // namespace cohort::tool
