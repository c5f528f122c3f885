// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/ros_simulation_queries.hpp"
#include "idl/messages/ros_simulation_services.hpp"
#include "server/description/experiment.hpp"

namespace cohort::ros2 {

namespace simulation = messages::ros::simulation;

/// A robot that a service has added.
struct SpawnedRobot {
  std::string name;
  description::ParsedModelPtr model;  ///< null: a model of the experiment
  bool is_driven = true;              ///< ROS nodes may drive it
};

/// Called on the thread of the services when a service has added or removed an entity.
struct EntityListener {
  std::function<void(SpawnedRobot robot)> spawned;
  std::function<void(const std::string& entity)> deleted;
};

/// Answers of the services for entities and the world. The functions throw ControlError if a request to the
/// server fails. Not thread-safe.
class EntityServices {
 public:
  using MakeExperiment = std::function<std::shared_ptr<const description::Experiment>()>;
  /// `experiment` is called at the first request that needs it. `run` must outlive this.
  EntityServices(Control& run, MakeExperiment experiment, EntityListener listener)
      : run_(run), make_experiment_(std::move(experiment)), listener_(std::move(listener)) {}

  simulation::SpawnEntity::Response answer(const simulation::SpawnEntity::Request& asked);
  simulation::SpawnEntities::Response answer(const simulation::SpawnEntities::Request& asked);
  simulation::DeleteEntity::Response answer(const simulation::DeleteEntity::Request& asked);
  simulation::GetEntities::Response answer(const simulation::GetEntities::Request& asked);
  /// Unless the run is paused, the states may be of different ticks, as their stamps say.
  simulation::GetEntitiesStates::Response answer(const simulation::GetEntitiesStates::Request& asked);
  simulation::GetEntityState::Response answer(const simulation::GetEntityState::Request& asked);
  simulation::SetEntityState::Response answer(const simulation::SetEntityState::Request& asked);
  simulation::GetEntityInfo::Response answer(const simulation::GetEntityInfo::Request& asked);
  simulation::GetSpawnables::Response answer(const simulation::GetSpawnables::Request& asked);
  simulation::GetCurrentWorld::Response answer(const simulation::GetCurrentWorld::Request&);

 private:
  const description::Experiment& experiment();
  /// Returns the index of an entity's model in the experiment's world; nullopt if the entity is unknown.
  std::optional<std::size_t> model_of(const std::string& entity);
  simulation::EntityCategory category_of(const std::string& entity);
  bool is_selected(const std::string& entity, const simulation::EntityFilters& filters);
  void note_spawned(const std::string& entity, const Spawn& asked, bool is_driven);

  Control& run_;
  MakeExperiment make_experiment_;
  EntityListener listener_;
  std::shared_ptr<const description::Experiment> experiment_;
  std::map<std::string, std::size_t> models_;  // by entity: of the experiment, or spawned here
};

}  // namespace cohort::ros2
