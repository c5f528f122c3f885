// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/entity_services.hpp"

#include <algorithm>
#include <utility>

#include "idl/messages/ros_messages.hpp"
#include "tools/bridges/ros2/simulation/service_results.hpp"

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;
using simulation::EntityCategory;
using simulation::Result;

constexpr const char* world_frame = "world";
constexpr std::string_view undriven = "?undriven";  // after the name of a model

// Why a pose cannot be used; empty if it can.
std::string frame_problem(const ros::Header& header) {
  if (header.frame_id.empty() || header.frame_id == world_frame) return {};
  return "frame_id '" + header.frame_id + "': expected 'world' or an empty frame_id";
}

WorldPose from_ros(const ros::Pose& pose) {
  const auto& [position, orientation] = pose;
  return {{position.x, position.y, position.z}, {orientation.x, orientation.y, orientation.z, orientation.w}};
}

Twist from_ros(const ros::Twist& twist) {
  return {{twist.linear.x, twist.linear.y, twist.linear.z}, {twist.angular.x, twist.angular.y, twist.angular.z}};
}

ros::Vector3 to_ros(const Vector3& vector) { return {vector.x, vector.y, vector.z}; }

simulation::EntityState to_ros(const EntityState& state, std::chrono::nanoseconds time) {
  const auto& [position, orientation] = state.pose;
  return {.header = {ros::time(time), world_frame},
          .pose = {{position.x, position.y, position.z}, {orientation.x, orientation.y, orientation.z, orientation.w}},
          .twist = {to_ros(state.twist.linear), to_ros(state.twist.angular)},
          .acceleration = {}};
}

// Why entities cannot be selected so; nothing if they can.
std::optional<Result> filter_problem(const simulation::EntityFilters& filters) {
  if (!filters.tags.tags.empty()) return Result{Result::feature_unsupported, "filters.tags: entities have no tags"};
  if (filters.bounds.type_of_bounds != simulation::Bounds::empty)
    return Result{Result::feature_unsupported, "filters.bounds: entities cannot be selected by position"};
  return {};
}

}  // namespace

const description::Experiment& EntityServices::experiment() {
  if (!experiment_) {
    experiment_ = make_experiment_();
    for (const description::Instance& each : experiment_->world.instances) models_.emplace(each.name, each.model);
  }
  return *experiment_;
}

std::optional<std::size_t> EntityServices::model_of(const std::string& entity) {
  experiment();
  const auto found = models_.find(entity);
  return found == models_.end() ? std::nullopt : std::optional(found->second);
}

EntityCategory EntityServices::category_of(const std::string& entity) {
  const std::optional<std::size_t> index = model_of(entity);
  if (!index) return {EntityCategory::object};
  const description::Model& model = experiment().world.models[*index];
  if (model.is_robot()) return {EntityCategory::robot};
  return {model.why_fixed() != nullptr ? EntityCategory::static_object : EntityCategory::dynamic_object};
}

bool EntityServices::is_selected(const std::string& entity, const simulation::EntityFilters& filters) {
  if (filters.categories.empty()) return true;
  return std::ranges::find(filters.categories, category_of(entity)) != filters.categories.end();
}

simulation::SpawnEntity::Response EntityServices::answer(const simulation::SpawnEntity::Request& asked) {
  using simulation::SpawnResult;
  if (!asked.entity_namespace.empty())
    return {{SpawnResult::namespace_invalid, "entity_namespace '" + asked.entity_namespace +
                                                 "': namespaces of robots are set by the experiment's key 'ros2'; "
                                                 "expected an empty one"},
            {}};
  if (const std::string problem = frame_problem(asked.initial_pose.header); !problem.empty())
    return {{SpawnResult::invalid_pose, problem}, {}};
  Spawn spawn{.name = asked.name,
              .allow_renaming = asked.allow_renaming,
              .model = asked.entity_resource.uri,
              .text = asked.entity_resource.resource_string,
              .pose = from_ros(asked.initial_pose.pose)};
  const bool is_driven = !spawn.model.ends_with(undriven);
  if (!is_driven) spawn.model.resize(spawn.model.size() - undriven.size());
  // A name is the simulator's to find if it may be another one.
  if (spawn.name.empty() && spawn.allow_renaming) spawn.name = spawn.model.empty() ? "entity" : spawn.model;
  std::string entity;
  try {
    entity = run_.spawn(spawn);
  } catch (const ControlError& error) {
    return {result_of(error, SpawnResult::invalid_pose), {}};
  }
  note_spawned(entity, spawn, is_driven);
  return {result_of(run_.last_reply()), entity};
}

void EntityServices::note_spawned(const std::string& entity, const Spawn& asked, bool is_driven) {
  const auto& models = experiment().world.models;
  if (!asked.text.empty()) {
    models_.erase(entity);
    description::ParsedModelPtr parsed = experiment().read_model(asked.text);
    if (parsed->model.is_robot()) listener_.spawned({entity, std::move(parsed), is_driven});
    return;
  }
  const auto model = std::ranges::find(models, asked.model, &description::Model::name);
  if (model == models.end()) return;
  models_[entity] = static_cast<std::size_t>(model - models.begin());
  if (model->is_robot()) listener_.spawned({entity, nullptr, is_driven});
}

simulation::SpawnEntities::Response EntityServices::answer(const simulation::SpawnEntities::Request& asked) {
  simulation::SpawnEntities::Response response{{Result::ok, {}}, {}};
  for (const simulation::EntityToSpawn& each : asked.spawn_requests) {
    auto [result, name] = answer(simulation::SpawnEntity::Request{each.name, each.allow_renaming, each.entity_resource,
                                                                  each.entity_namespace, each.initial_pose});
    if (result.result != Result::ok)
      response.result = {simulation::SpawnEntities::Response::entities_spawn_failed, result.error_message};
    response.results.push_back({std::move(result), std::move(name)});
  }
  return response;
}

simulation::DeleteEntity::Response EntityServices::answer(const simulation::DeleteEntity::Request& asked) {
  const ControlReply reply = run_.remove(asked.entity);
  listener_.deleted(asked.entity);
  return {result_of(reply)};
}

simulation::GetEntities::Response EntityServices::answer(const simulation::GetEntities::Request& asked) {
  if (const auto problem = filter_problem(asked.filters)) return {*problem, {}};
  simulation::GetEntities::Response response{{}, run_.entities(asked.filters.filter)};
  response.result = result_of(run_.last_reply());
  std::erase_if(response.entities, [&](const std::string& entity) { return !is_selected(entity, asked.filters); });
  return response;
}

simulation::GetEntitiesStates::Response EntityServices::answer(const simulation::GetEntitiesStates::Request& asked) {
  const auto [result, names] = answer(simulation::GetEntities::Request{asked.filters});
  simulation::GetEntitiesStates::Response response{result, {}, {}};
  for (const std::string& name : names) {
    try {
      const EntityState state = run_.entity_state(name);
      response.entities.push_back(name);
      response.states.push_back(to_ros(state, run_.last_reply().time));
    } catch (const ControlError& error) {
      if (error.result != ControlResult::not_found) throw;  // otherwise it has gone meanwhile
    }
  }
  return response;
}

simulation::GetEntityState::Response EntityServices::answer(const simulation::GetEntityState::Request& asked) {
  const EntityState state = run_.entity_state(asked.entity);
  return {result_of(run_.last_reply()), to_ros(state, run_.last_reply().time)};
}

simulation::SetEntityState::Response EntityServices::answer(const simulation::SetEntityState::Request& asked) {
  if (const std::string problem = frame_problem(asked.state.header); !problem.empty())
    return {{simulation::SetEntityState::Response::invalid_pose, problem}};
  if (asked.set_acceleration)
    return {{Result::feature_unsupported, "acceleration cannot be set: expected a pose or a twist"}};
  const EntityState state{asked.entity, from_ros(asked.state.pose), from_ros(asked.state.twist)};
  if (asked.set_pose && asked.set_twist) return {result_of(run_.set_entity_state(state))};
  if (asked.set_pose) return {result_of(run_.set_pose(state.entity, state.pose))};
  if (asked.set_twist) return {result_of(run_.set_twist(state.entity, state.twist))};
  return {{Result::operation_failed, "expected a pose, a twist or both"}};
}

simulation::GetEntityInfo::Response EntityServices::answer(const simulation::GetEntityInfo::Request& asked) {
  run_.entity_state(asked.entity);
  const auto model = model_of(asked.entity);
  const std::string description = model ? "model " + experiment().world.models[*model].name : std::string();
  return {result_of(run_.last_reply()), {category_of(asked.entity), description, {}}};
}

simulation::GetSpawnables::Response EntityServices::answer(const simulation::GetSpawnables::Request& asked) {
  if (!asked.sources.empty())
    return {{Result::feature_unsupported, "sources: only the models of the world can be spawned; expected no sources"},
            {}};
  simulation::GetSpawnables::Response response{{Result::ok, {}}, {}};
  for (const description::Model& model : experiment().world.models)
    response.spawnables.push_back({{model.name, {}}, model.is_robot() ? "a robot" : "an object", {}});
  return response;
}

simulation::GetCurrentWorld::Response EntityServices::answer(const simulation::GetCurrentWorld::Request&) {
  const description::Experiment& current = experiment();
  return {{Result::ok, {}}, {current.name, {current.file.string(), {}}, {}, {}}};
}

}  // namespace cohort::ros2
