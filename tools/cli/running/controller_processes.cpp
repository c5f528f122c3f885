// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/controller_processes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "server/description/select_robots.hpp"
#include "tools/cli/common/exit_codes.hpp"

namespace cohort::tool {

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

std::filesystem::path identity_for(const description::Experiment& experiment, const description::Team& team,
                                   const std::filesystem::path& secure) {
  for (const wire::Identity& identity : wire::read_server_identities(secure)) {
    const auto allowed = description::select_robots_of_any(experiment.world, identity.robots);
    if (std::ranges::includes(allowed, team.robots))
      return std::filesystem::absolute(secure) / "clients" / identity.name;
  }
  throw std::runtime_error(fmt::format(
      "no client in {0} may drive all robots of team '{1}'; 'cohort security add {0} {1} --robots {2}' adds one",
      secure.string(), team.name, selectors_of(team.robots)));
}

std::vector<Children::Command> controller_processes(const description::Experiment& experiment,
                                                    const std::vector<TeamController>& controllers, bool per_robot,
                                                    const std::vector<std::uint32_t>& domains,
                                                    const std::filesystem::path& secure, const Log& log) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<Children::Command> commands;
  for (std::size_t i = 0; i < experiment.teams.size(); ++i) {
    const description::Team& team = experiment.teams[i];
    if (!controllers[i].is_started()) continue;
    const std::string identity = secure.empty() ? std::string() : identity_for(experiment, team, secure).string();
    const auto add = [&](const std::vector<std::uint32_t>& robots) {
      const std::uint32_t domain = domains[commands.size() % domains.size()];
      Children::Command command;
      command.arguments = {
          program,     "host",     controllers[i].plugin->path(), "--robots", selectors_of(robots), "--server",
          "127.0.0.1", "--domain", std::to_string(domain),        "--for-run"};
      if (!identity.empty()) command.arguments.insert(command.arguments.end(), {"--secure", identity});
      if (log.format() == LogFormat::json) command.arguments.insert(command.arguments.end(), {"--log-format", "json"});
      if (log.shows(LogLevel::info)) command.arguments.push_back("--verbose");
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

Children::Command ros2_bridge_process(const description::Experiment& experiment,
                                      const std::vector<std::uint32_t>& robots, const std::string& server,
                                      std::uint32_t domain, const std::filesystem::path& secure) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "cohort-ros2-bridge";
  if (!std::filesystem::exists(program))
    throw std::runtime_error("'--ros2' requires the program " + program.string() + ", which is not installed");
  Children::Command command;
  command.arguments = {program, "--robots", selectors_of(robots),  "--server",
                       server,  "--domain", std::to_string(domain)};
  if (!secure.empty()) {
    description::Team driven;
    driven.name = "ros2";
    driven.robots = robots;
    command.arguments.insert(command.arguments.end(), {"--secure", identity_for(experiment, driven, secure).string()});
  }
  command.name = "the bridge to ROS 2";
  command.restarts = false;
  command.is_controller = false;
  return command;
}

Children::Listener listener_of_controllers(session::Server& server, Log& log) {
  Children::Listener listener;
  listener.started = [&](const Children::Command& command, pid_t pid) {
    log.info(fmt::format("{}: started controller process {}: {}", command.name, pid, fmt::join(command.arguments, " ")),
             {{"controller_of", command.name}, {"process", pid}, {"command", command.arguments}});
  };
  listener.restarted = listener.killed = [&](const Children::Command& command, const std::string& text) {
    log.warning(text, {{"controller_of", command.name}});
  };
  listener.ended = [&](pid_t pid, int) { server.note_process_end(static_cast<std::uint32_t>(pid)); };
  listener.gave_up = [&](const std::string& text) { server.fail(text); };
  listener.may_end_with = [](int exit_code) { return exit_code == exit_superseded; };
  // A host writes JSON itself on request, but its controllers do not, nor does a language runtime that aborts the
  // process.
  if (log.format() == LogFormat::json)
    listener.wrote = [&](const Children::Command& command, const std::string& line) {
      log.echo(line, {{"controller_of", command.name}});
    };
  return listener;
}

}  // namespace cohort::tool
