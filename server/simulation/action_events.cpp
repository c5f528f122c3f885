// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/action_events.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "server/core/overloaded.hpp"
#include "server/core/text.hpp"
#include "server/simulation/action_error.hpp"

namespace cohort {
namespace {

constexpr double furthest = 1e6;  // a body farther away has left the world [m]
constexpr double unit_tolerance = 1e-3;
constexpr std::chrono::nanoseconds longest_push = std::chrono::hours(24 * 365);

[[noreturn]] void refuse(ActionFault fault, const std::string& why) { throw ActionError(fault, why); }

std::string quoted(const std::string& name) { return "'" + name + "'"; }

std::vector<std::string> names_in_world(const Objects& objects) {
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (std::uint32_t object = 0; object < objects.size(); ++object)
    if (objects.is_present(object)) names.push_back(objects.name(object));
  return names;
}

std::uint32_t find_object(const std::string& name, const ActionScope& scope,
                          ActionFault not_found = ActionFault::object_not_found) {
  check_name(name, "the name of the object", not_found);
  const std::optional<std::uint32_t> object = scope.objects.find(name);
  if (!object)
    refuse(not_found, "there is no object " + quoted(name) + suggestion(name, names_in_world(scope.objects)));
  if (!scope.objects.is_present(*object)) refuse(not_found, quoted(name) + " is not in the world");
  return *object;
}

std::uint32_t find_working_object(const std::string& name, const ActionScope& scope,
                                  ActionFault not_found = ActionFault::object_not_found) {
  const std::uint32_t object = find_object(name, scope, not_found);
  if (scope.objects.is_quarantined(object)) refuse(ActionFault::quarantined, quoted(name) + " is quarantined");
  return object;
}

const description::Model& model_of(std::uint32_t object, const ActionScope& scope) {
  return scope.description.models[scope.world.model_of(BodyId{object})];
}

void check_finite(const Eigen::Vector3d& vector, const std::string& what) {
  if (!vector.allFinite()) refuse(ActionFault::invalid_value, "the " + what + " is not finite");
}

description::Event event_of_kind(const RemoveObject& remove, const ActionScope& scope) {
  return {{}, find_object(remove.name, scope), description::SetPresence{false, true}, "remove"};
}

description::Event event_of_kind(const SetPose& set, const ActionScope& scope) {
  return {{}, find_working_object(set.name, scope), description::PlaceAt{checked_pose(set.X_WM)}, "set_pose"};
}

description::Event event_of_kind(const SetVelocity& set, const ActionScope& scope) {
  const std::uint32_t object = find_working_object(set.name, scope);
  if (const char* const why = model_of(object, scope).why_fixed())
    refuse(ActionFault::immovable, quoted(set.name) + " " + why);
  check_finite(set.linear_W, "velocity");
  check_finite(set.angular_W, "angular velocity");
  return {{}, object, description::SetVelocity{set.linear_W, set.angular_W}, "set_velocity"};
}

description::Event event_of_kind(const ApplyForce& apply, const ActionScope& scope) {
  const std::uint32_t object = find_working_object(apply.name, scope);
  const description::Model& model = model_of(object, scope);
  if (model.is_static) refuse(ActionFault::immovable, quoted(apply.name) + " is static");
  check_finite(apply.force_W, "force");
  check_finite(apply.torque_W, "torque");
  if (apply.duration.count() < 0 || apply.duration > longest_push)
    refuse(ActionFault::invalid_value, "expected a duration from 0 s to one year");
  std::size_t link = 0;
  if (!apply.link.empty()) {
    check_name(apply.link, "the name of the link", ActionFault::link_not_found);
    std::vector<std::string> names;
    names.reserve(model.links.size());
    for (const description::Link& each : model.links) names.push_back(each.name);
    link = static_cast<std::size_t>(std::ranges::find(names, apply.link) - names.begin());
    if (link == names.size())
      refuse(ActionFault::link_not_found,
             quoted(apply.name) + " has no link " + quoted(apply.link) + suggestion(apply.link, names));
  }
  return {{}, object, description::ApplyForce{link, apply.force_W, apply.torque_W, apply.duration}, "apply_force"};
}

// ---- Lights ----

std::vector<std::size_t> lights_of(const description::Model& model) {
  std::vector<std::size_t> lights;
  for (std::size_t i = 0; i < model.emitters.size(); ++i)
    if (std::holds_alternative<description::Light>(model.emitters[i].what)) lights.push_back(i);
  return lights;
}

// Parses `object/light`, where both parts may contain slashes; returns nothing if there is no such object.
std::optional<std::pair<std::uint32_t, std::size_t>> find_light(const std::string& name, const ActionScope& scope) {
  for (std::size_t slash = name.rfind('/'); slash != std::string::npos && slash > 0;
       slash = name.rfind('/', slash - 1)) {
    const std::optional<std::uint32_t> object = scope.objects.find(name.substr(0, slash));
    if (!object) continue;
    const description::Model& model = model_of(*object, scope);
    const std::string wanted = name.substr(slash + 1);
    std::vector<std::string> names;
    for (const std::size_t light : lights_of(model)) {
      if (model.emitters[light].name == wanted) return std::pair{*object, light};
      names.push_back(model.emitters[light].name);
    }
    refuse(ActionFault::light_not_found,
           quoted(scope.objects.name(*object)) + " has no light " + quoted(wanted) + suggestion(wanted, names));
  }
  return std::nullopt;
}

std::vector<std::string> names_of_lights(const ActionScope& scope) {
  std::vector<std::string> names;
  for (std::uint32_t object = 0; object < scope.objects.size(); ++object) {
    const description::Model& model = model_of(object, scope);
    if (!scope.objects.is_present(object) || lights_of(model).empty()) continue;
    names.push_back(scope.objects.name(object));
    for (const std::size_t light : lights_of(model))
      names.push_back(scope.objects.name(object) + "/" + model.emitters[light].name);
  }
  return names;
}

description::Event event_of_kind(const SetLight& set, const ActionScope& scope) {
  check_name(set.name, "the name of the light", ActionFault::light_not_found);
  description::SetEmitters effect;
  effect.change.is_on = set.on;
  effect.change.intensity = set.intensity;
  effect.change.color = set.color;
  if (set.intensity && !(*set.intensity >= 0.0 && std::isfinite(*set.intensity)))
    refuse(ActionFault::invalid_value, "expected an intensity of at least 0");
  if (set.color && !((set.color->array() >= 0.0).all() && (set.color->array() <= 1.0).all()))
    refuse(ActionFault::invalid_value, "expected red, green and blue from 0 to 1");
  std::string object = set.name;
  if (!scope.objects.find(set.name)) {
    const auto light = find_light(set.name, scope);
    if (!light)
      refuse(ActionFault::light_not_found,
             "there is no light or object " + quoted(set.name) + suggestion(set.name, names_of_lights(scope)));
    object = scope.objects.name(light->first);
    effect.emitters.push_back(light->second);
  }
  const std::uint32_t index = find_working_object(object, scope, ActionFault::light_not_found);
  if (effect.emitters.empty()) effect.emitters = lights_of(model_of(index, scope));
  if (effect.emitters.empty())
    refuse(ActionFault::light_not_found,
           quoted(set.name) + " has no light" + suggestion(set.name, names_of_lights(scope)));
  return {{}, index, std::move(effect), "set_light"};
}

}  // namespace

Pose checked_pose(const Pose& X_WM) {
  const double norm = X_WM.orientation.norm();
  if (!X_WM.position.allFinite() || !X_WM.orientation.coeffs().allFinite())
    refuse(ActionFault::invalid_pose, "the pose is not finite");
  if (X_WM.position.cwiseAbs().maxCoeff() > furthest)
    refuse(ActionFault::invalid_pose, "expected a position within 1,000 km of the origin");
  if (std::abs(norm - 1.0) > unit_tolerance)
    refuse(ActionFault::invalid_pose, "expected a unit quaternion as the orientation of the pose");
  return {X_WM.position, norm == 1.0 ? X_WM.orientation : X_WM.orientation.normalized()};
}

std::string name_of_new(const SpawnObject& spawn, const std::string& model, const Objects& objects) {
  const std::string& wanted = spawn.name.empty() ? model : spawn.name;
  check_name(wanted, "the name of the object", ActionFault::name_invalid);
  if (!is_object_name(wanted))
    refuse(ActionFault::name_invalid, quoted(wanted) + " is not a valid name: expected parts separated by slashes");
  if (!objects.find(wanted)) return wanted;
  if (!spawn.allow_renaming)
    refuse(ActionFault::name_not_unique, objects.is_present(*objects.find(wanted))
                                             ? "another object has the name " + quoted(wanted)
                                             : "an object that has left the world, or is added later, has the name " +
                                                   quoted(wanted) + "; names are not reused in a run");
  for (std::size_t number = 1;; ++number)
    if (std::string name = wanted + "_" + std::to_string(number); !objects.find(name)) return name;
}

std::optional<std::size_t> team_of_new(const SpawnObject& spawn, std::size_t model,
                                       const description::Experiment& experiment) {
  const description::World& world = experiment.world;
  const std::string& model_name = world.models[model].name;
  check_name(spawn.team, "the name of the team", ActionFault::invalid_team);
  if (!world.models[model].is_robot()) {
    if (!spawn.team.empty())
      refuse(ActionFault::invalid_team,
             "the model " + quoted(model_name) + " is not a robot, so it cannot join a team");
    return std::nullopt;
  }
  std::vector<std::string> names;
  std::vector<std::size_t> of_this_model;
  for (std::size_t team = 0; team < experiment.teams.size(); ++team) {
    names.push_back(experiment.teams[team].name);
    if (std::ranges::any_of(experiment.teams[team].robots,
                            [&](std::uint32_t robot) { return world.robot(robot).model == model; }))
      of_this_model.push_back(team);
  }
  if (!spawn.team.empty()) {
    const auto found = std::ranges::find(names, spawn.team);
    if (found == names.end())
      refuse(ActionFault::invalid_team, "there is no team " + quoted(spawn.team) + suggestion(spawn.team, names));
    return static_cast<std::size_t>(found - names.begin());
  }
  if (names.empty())
    refuse(ActionFault::invalid_team,
           quoted(model_name) + " is a robot, but the experiment has no team that it can join");
  if (names.size() == 1) return 0;
  if (of_this_model.size() == 1) return of_this_model.front();
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  refuse(ActionFault::invalid_team, quoted(model_name) + " is a robot: expected one of the teams " + list);
}

description::Event event_of(const Action& action, const ActionScope& scope) {
  return std::visit(Overloaded{[](const SpawnObject&) -> description::Event {
                                 throw std::logic_error("a new object is not an event");
                               },
                               [&](const auto& kind) { return event_of_kind(kind, scope); }},
                    action);
}

}  // namespace cohort
