// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "server/actuation/user_actions.hpp"
#include "server/core/channel.hpp"
#include "server/description/world.hpp"
#include "server/emission/emitters.hpp"
#include "server/gripping/detachable_joints.hpp"
#include "server/gripping/grippers.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::actuation {

/// An actuator that acts on the world: one object for each device of each robot.
class Actuator {
 public:
  virtual ~Actuator() = default;
  /// Returns the channels that `apply` reads, in order.
  virtual std::vector<Channel> channels() const = 0;
  /// Sets the device's targets for the next step. `values` has one value for each float64 of the channels, all within
  /// range. Called in the order of the robots, on one thread.
  virtual void apply(std::span<const double> values) = 0;
};

/// The robot and the objects that an actuator acts on. They must outlive the actuator.
struct Mount {
  physics::World& world;
  emission::Emitters& emitters;
  const description::World& description;
  gripping::Grippers& grippers;
  gripping::DetachableJoints& detachable_joints;
  UserActions& actions;
  BodyId body;      ///< the robot's body; also its index among the description's instances
  DeviceId device;  ///< index in the robot's model

  const description::Model& model() const { return description.models[description.instances[body.value].model]; }
  const description::Joint& joint(std::size_t index) const { return model().joints[index]; }
};

}  // namespace cohort::actuation
