// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/team_controllers.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "client_sdk/hosting/controller_call.hpp"
#include "server/description/input_error.hpp"
#include "server/run/roster.hpp"

namespace cohort::tool {
namespace {

using description::Experiment;
using description::Problem;
using description::Team;

std::string element_of(const Experiment& experiment, const Team& team, const std::string& key) {
  return "teams[" + std::to_string(&team - experiment.teams.data()) + "]." + key;
}

Problem problem_of_controller(const Experiment& experiment, const Team& team, const std::string& message) {
  return {experiment.file, team.controller_line, element_of(experiment, team, "controller"), message};
}

std::optional<Problem> try_controller(const Experiment& experiment, const Team& team, const ControllerKind& kind,
                                      const wire::Admit& admit,
                                      const std::vector<wire::RobotDescription>& descriptions) {
  try {
    Start start = start_of(admit, admit.robots.front(), descriptions);
    start.reason = StartReason::check;
    const Callee callee(team.controller, start.name, team.name);
    const ControllerCall under_way(callee, "start", start.tick);
    if (kind.create_for_all) {
      make_handler(kind)->start(admit, descriptions);
      return std::nullopt;
    }
    kind.create()->start(start);
    start.parameters.check_all_were_asked_for();
  } catch (const ParameterError& error) {
    const auto given = std::ranges::find(team.parameters, error.name(), &description::Parameter::name);
    if (given == team.parameters.end()) return problem_of_controller(experiment, team, error.what());
    return Problem{experiment.file, given->line, element_of(experiment, team, "parameters"), error.what()};
  } catch (const std::exception& error) {
    return problem_of_controller(experiment, team, error.what());
  }
  return std::nullopt;
}

bool is_plugin(const Team& team) { return team.controller != keyboard_controller && !team.controller.empty(); }

// Calls `use` with each team whose controller is a plugin, and with the plugin's name or path. Collects the exceptions.
template <class Use>
void for_plugins(const Experiment& experiment, const Use& use) {
  std::vector<Problem> problems;
  for (const Team& team : experiment.teams) {
    if (!is_plugin(team)) continue;
    std::string name = team.controller;
    if (is_controller_path(name) && std::filesystem::path(name).is_relative())
      name = experiment.file.parent_path() / name;
    try {
      use(team, name);
    } catch (const std::runtime_error& error) {
      problems.push_back(problem_of_controller(experiment, team, error.what()));
    }
  }
  if (!problems.empty()) throw description::InputError(std::move(problems));
}

}  // namespace

ControllerKind TeamController::kind() const {
  if (plugin) return plugin->kind();
  return {keyboard_controller, [] { return keyboard_controller_without_keys(); }};
}

bool has_keyboard(const Experiment& experiment) {
  return std::ranges::any_of(experiment.teams, [](const Team& team) { return team.controller == keyboard_controller; });
}

void check_controllers(const Experiment& experiment) {
  for_plugins(experiment,
              [](const Team&, const std::string& name) { check_controller(name, default_plugin_directories()); });
}

std::vector<TeamController> load_controllers(const Experiment& experiment) {
  std::vector<TeamController> controllers(experiment.teams.size());
  for_plugins(experiment, [&](const Team& team, const std::string& name) {
    controllers[static_cast<std::size_t>(&team - experiment.teams.data())].plugin.emplace(name,
                                                                                          default_plugin_directories());
  });
  return controllers;
}

void try_controllers(const Experiment& experiment, const Simulation& simulation,
                     const std::vector<TeamController>& controllers) {
  const std::vector<wire::RobotDescription> descriptions = session::describe_kinds(simulation);
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < experiment.teams.size(); ++i) {
    const Team& team = experiment.teams[i];
    if (team.controller.empty()) continue;
    std::set<std::uint32_t> kinds_tried;
    for (const std::uint32_t robot : team.robots) {
      if (!kinds_tried.insert(simulation.kind_of(robot)).second) continue;
      wire::Admit admit;
      admit.step_ns = experiment.world.step.count();
      session::admit_robots(admit, experiment, simulation, std::vector<std::uint32_t>{robot});
      if (auto problem = try_controller(experiment, team, controllers[i].kind(), admit, descriptions))
        problems.push_back(std::move(*problem));
    }
  }
  if (!problems.empty()) throw description::InputError(std::move(problems));
}

}  // namespace cohort::tool
