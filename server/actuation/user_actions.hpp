// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/world.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::actuation {

/// A user-defined action of one robot.
struct ActionOfRobot {
  std::string name;
  RobotId robot;
  BodyId body;
  double value = 0.0;    ///< commanded in the last step; 0 if the robot was not in the world
  bool is_done = false;  ///< the value is above `UserActions::threshold`
  bool begins = false;   ///< not done in the previous step
};

/// The user-defined actions of robots, which no joint represents (description::UserAction). Commands come from one
/// thread, between steps.
class UserActions {
 public:
  /// The robot acts while the commanded value is above this threshold [1].
  static constexpr double threshold = 0.5;

  /// The arguments must outlive this object.
  UserActions(const description::World& description, const physics::World& world);

  /// Adds the robot with the next id, whose body is in the world.
  void add_robot(RobotId robot, BodyId body, const description::Model& model);
  /// Returns the index of the action of a robot's device.
  std::uint32_t of_device(BodyId body, DeviceId device) const { return numbers_.at({world_.slot_of(body), device}); }
  void command(std::uint32_t action, double value) { actions_[action].value = value; }
  /// Determines which actions begin; to be called after each step.
  void finish_step();

  /// Returns all actions, in the order of the slots of the robots' bodies, then of their devices.
  std::span<const ActionOfRobot> all() const { return actions_; }

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  const physics::World& world_;
  std::vector<ActionOfRobot> actions_;
  std::map<std::pair<std::uint32_t, DeviceId>, std::uint32_t> numbers_;  // by slot of the body and device
};

}  // namespace cohort::actuation
