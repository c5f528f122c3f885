#include "server/serving/control/control_actions.hpp"

#include <cmath>
#include <optional>

namespace cohort::session {
namespace {

using wire::Operation;
using wire::Request;
using wire::ResultCode;

Eigen::Vector3d from_wire(const wire::Vector3& v) { return {v.x, v.y, v.z}; }

Pose from_wire(const wire::Pose& pose) {
  const wire::Quaternion& q = pose.orientation;
  return {from_wire(pose.position), Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
}

// A unit quaternion but for what rounding did to it.
bool has_orientation(const wire::Pose& pose) {
  constexpr double tolerance = 1e-3;
  const wire::Quaternion& q = pose.orientation;
  return std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0) < tolerance;
}

std::vector<Action> state_actions(const Request& request) {
  std::vector<Action> actions;
  if (request.set_pose) actions.emplace_back(SetPose{request.entity, from_wire(request.pose)});
  if (request.set_twist)  // a new pose is one at rest
    actions.emplace_back(
        SetVelocity{request.entity, from_wire(request.twist.linear), from_wire(request.twist.angular)});
  return actions;
}

std::vector<Action> actions_of(const Request& request) {
  switch (request.operation) {
    case Operation::spawn_entity:
      return {SpawnObject{request.entity, request.resource_string.empty() ? request.uri : request.resource_string,
                          from_wire(request.pose), request.allow_renaming, request.filter}};
    case Operation::delete_entity: return {RemoveObject{request.entity}};
    case Operation::set_entity_state: return state_actions(request);
    case Operation::set_light: {
      SetLight light{.name = request.entity, .on = request.on};
      if (request.set_intensity) light.intensity = request.intensity;
      if (request.set_color) light.color = from_wire(request.color);
      return {light};
    }
    case Operation::apply_force:
      return {ApplyForce{request.entity, request.link, from_wire(request.force), from_wire(request.torque),
                         std::chrono::nanoseconds(request.duration_ns)}};
    default: return {};
  }
}

// What can be seen without the world, with its result.
struct Refusal {
  ResultCode result;
  std::string text;
};
std::optional<Refusal> refusal_of(const Request& request) {
  const bool spawns = request.operation == Operation::spawn_entity;
  if (spawns && request.uri.empty() && request.resource_string.empty())
    return Refusal{ResultCode::no_resource, "neither a model of the world nor the text of one is given"};
  if (request.operation == Operation::set_entity_state && !request.set_pose && !request.set_twist)
    return Refusal{ResultCode::malformed, "neither a pose nor a twist is to be set"};
  if ((spawns || request.set_pose) && !has_orientation(request.pose))
    return Refusal{spawns ? ResultCode::invalid_spawn_pose : ResultCode::invalid_pose,
                   "the orientation is no unit quaternion"};
  return std::nullopt;
}

// Why it could not be done, in simulation_interfaces's numbers.
ResultCode code_of_failure(const Request& request, const Objects& objects) {
  const bool is_known = objects.find(request.entity).has_value();
  if (request.operation == Operation::spawn_entity)
    return is_known && !request.allow_renaming ? ResultCode::name_not_unique : ResultCode::operation_failed;
  return is_known || request.operation == Operation::set_light ? ResultCode::operation_failed : ResultCode::not_found;
}

}  // namespace

bool is_action(const Request& request) {
  switch (request.operation) {
    case Operation::spawn_entity:
    case Operation::delete_entity:
    case Operation::set_entity_state:
    case Operation::set_light:
    case Operation::apply_force: return true;
    default: return false;
  }
}

std::vector<ActionOutcome> act(Simulation& simulation, std::span<const Request> requests) {
  std::vector<ActionOutcome> outcomes;
  std::vector<Action> actions;
  std::vector<const Request*> origins;  // of each action
  for (const Request& request : requests) {
    if (const auto refusal = refusal_of(request)) {
      outcomes.push_back({&request, refusal->result, refusal->text});
      continue;
    }
    for (Action& action : actions_of(request)) {
      actions.push_back(std::move(action));
      origins.push_back(&request);
    }
  }
  const Objects& objects = simulation.objects();
  std::uint32_t spawned = objects.size();
  std::vector<ActionResult> results;
  try {
    results = simulation.act(actions);
  } catch (const std::exception& error) {
    results.assign(actions.size(), {false, error.what()});
  }
  for (std::size_t i = 0; i < actions.size();) {
    const Request& request = *origins[i];
    ActionOutcome& outcome = outcomes.emplace_back(ActionOutcome{&request});
    for (; i < actions.size() && origins[i] == &request; ++i) {
      outcome.text += (outcome.text.empty() ? "" : "; ") + results[i].text;
      if (results[i].is_done)
        outcome.done.push_back({results[i].text, to_bytes(actions[i])});
      else
        outcome.result = code_of_failure(request, objects);
    }
    outcome.entity = request.entity;
    if (request.operation == Operation::spawn_entity && outcome.result == ResultCode::ok)
      outcome.entity = objects.name(spawned++);
  }
  return outcomes;
}

}  // namespace cohort::session
