// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/control_actions.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

namespace cohort::session {
namespace {

using wire::Request;
using wire::ResultCode;

Eigen::Vector3d from_wire(const wire::Vector3& v) { return {v.x, v.y, v.z}; }

Pose from_wire(const wire::Pose& pose) {
  const wire::Quaternion& q = pose.orientation;
  return {from_wire(pose.position), Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
}

// Returns true for a unit quaternion, with a tolerance for rounding.
bool has_orientation(const wire::Pose& pose) {
  constexpr double tolerance = 1e-3;
  const wire::Quaternion& q = pose.orientation;
  return std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0) < tolerance;
}

void add_actions(const wire::SetEntityState& operation, std::vector<Action>& actions) {
  const std::string& entity = operation.entity;
  if (operation.pose) actions.emplace_back(SetPose{entity, from_wire(*operation.pose)});
  if (operation.twist)  // a new pose alone means at rest
    actions.emplace_back(SetVelocity{entity, from_wire(operation.twist->linear), from_wire(operation.twist->angular)});
}
void add_actions(const wire::SpawnEntity& operation, std::vector<Action>& actions) {
  actions.emplace_back(SpawnObject{operation.entity, operation.uri, from_wire(operation.pose), operation.allow_renaming,
                                   operation.team});
}
void add_actions(const wire::DeleteEntity& operation, std::vector<Action>& actions) {
  actions.emplace_back(RemoveObject{operation.entity});
}
void add_actions(const wire::SetLight& operation, std::vector<Action>& actions) {
  SetLight light{.name = operation.entity, .on = operation.on, .intensity = operation.intensity};
  if (operation.color) light.color = from_wire(*operation.color);
  actions.emplace_back(std::move(light));
}
void add_actions(const wire::ApplyForce& operation, std::vector<Action>& actions) {
  actions.emplace_back(ApplyForce{operation.entity, operation.link, from_wire(operation.force),
                                  from_wire(operation.torque), std::chrono::nanoseconds(operation.duration_ns)});
}

template <class Operation>
constexpr bool is_kind_of_action = requires(const Operation& operation, std::vector<Action>& actions) {
  add_actions(operation, actions);
};

std::vector<Action> actions_of(const Request& request, const ModelTexts& texts) {
  std::vector<Action> actions;
  std::visit(
      [&]<class One>(const One& operation) {
        if constexpr (is_kind_of_action<One>) add_actions(operation, actions);
      },
      request.operation);
  if (text_of_model(request) != nullptr)
    std::get<SpawnObject>(actions.front()).model = texts.find(key_of(request))->model;
  return actions;
}

const std::string& entity_of(const Request& request) {
  static const std::string none;
  return std::visit(
      [](const auto& operation) -> const std::string& {
        if constexpr (requires { operation.entity; })
          return operation.entity;
        else
          return none;
      },
      request.operation);
}

// A refusal that needs no look at the world, with its result code.
struct Refusal {
  ResultCode result;
  std::string text;
};
std::optional<Refusal> refusal_of(const Request& request, const ModelTexts& texts) {
  constexpr const char* no_orientation = "the orientation is not a unit quaternion";
  if (const auto* spawn = std::get_if<wire::SpawnEntity>(&request.operation)) {
    if (spawn->uri.empty() && spawn->resource_string.empty())
      return Refusal{ResultCode::no_resource, "expected the name of one of the world's models, or the text of a model"};
    if (!has_orientation(spawn->pose)) return Refusal{ResultCode::invalid_spawn_pose, no_orientation};
  }
  if (const auto* state = std::get_if<wire::SetEntityState>(&request.operation))
    if (state->pose && !has_orientation(*state->pose)) return Refusal{ResultCode::invalid_pose, no_orientation};
  if (text_of_model(request) == nullptr) return std::nullopt;
  if (const ModelTexts::Reading& reading = *texts.find(key_of(request)); reading.model == nullptr)
    return Refusal{reading.result, reading.why_not};
  return std::nullopt;
}

ResultCode code_of(ActionFault fault, bool is_spawn) {
  switch (fault) {
    case ActionFault::object_not_found: return ResultCode::not_found;
    case ActionFault::light_not_found: return ResultCode::light_not_found;
    case ActionFault::link_not_found: return ResultCode::link_not_found;
    case ActionFault::immovable: return ResultCode::immovable;
    case ActionFault::quarantined: return ResultCode::quarantined;
    case ActionFault::invalid_pose: return is_spawn ? ResultCode::invalid_spawn_pose : ResultCode::invalid_pose;
    case ActionFault::invalid_value: return ResultCode::malformed;
    case ActionFault::name_invalid: return ResultCode::name_invalid;
    case ActionFault::name_not_unique: return ResultCode::name_not_unique;
    case ActionFault::unknown_model: return ResultCode::unknown_model;
    case ActionFault::unsupported_model: return ResultCode::unsupported_assets;
    case ActionFault::invalid_team: return ResultCode::invalid_team;
    case ActionFault::too_many_objects: return ResultCode::too_many_objects;
    case ActionFault::other: break;
  }
  return ResultCode::operation_failed;
}

}  // namespace

bool is_action(const Request& request) {
  return std::visit([]<class One>(const One&) { return is_kind_of_action<One>; }, request.operation);
}

const std::string* text_of_model(const Request& request) {
  const auto* const spawn = std::get_if<wire::SpawnEntity>(&request.operation);
  return spawn == nullptr || spawn->resource_string.empty() ? nullptr : &spawn->resource_string;
}

std::vector<ActionOutcome> act(Simulation& simulation, std::span<const Request> requests, const ModelTexts& texts) {
  std::vector<ActionOutcome> outcomes;
  std::vector<Action> actions;
  std::vector<const Request*> origins;  // request of each action
  for (const Request& request : requests) {
    if (const auto refusal = refusal_of(request, texts)) {
      outcomes.push_back({&request, refusal->result, refusal->text});
      continue;
    }
    for (Action& action : actions_of(request, texts)) {
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
    const bool is_spawn = std::holds_alternative<wire::SpawnEntity>(request.operation);
    ActionOutcome& outcome = outcomes.emplace_back(ActionOutcome{&request});
    for (; i < actions.size() && origins[i] == &request; ++i) {
      outcome.text += (outcome.text.empty() ? "" : "; ") + results[i].text;
      if (results[i].is_done)
        outcome.done.push_back({results[i].text, to_bytes(actions[i])});
      else
        outcome.result = code_of(results[i].fault, is_spawn);
    }
    outcome.entity = entity_of(request);
    if (is_spawn && outcome.result == ResultCode::ok) outcome.entity = objects.name(spawned++);
  }
  return outcomes;
}

}  // namespace cohort::session
