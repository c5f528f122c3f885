#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "server/actuation/user_actions.hpp"
#include "server/core/channel.hpp"
#include "server/description/model.hpp"
#include "server/emission/emitters.hpp"
#include "server/gripping/grippers.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::actuation {

/// Acts on the world. One object for each device of each robot.
class Actuator {
 public:
  virtual ~Actuator() = default;
  /// The channels that `apply` reads, in order.
  virtual std::vector<Channel> channels() const = 0;
  /// Sets the device's targets for the step to come from one value for each float64 of the channels, all within range.
  /// Called in the order of the robots, on one thread.
  virtual void apply(std::span<const double> values) = 0;
};

/// What actuators act on, and the body of the robot that has them.
struct Mount {
  physics::World& world;
  emission::Emitters& emitters;
  gripping::Grippers& grippers;
  UserActions& actions;
  std::uint32_t body;
};

/// The actuator of a device (`device`: its index in `model`), or null if it only senses. What `mount` refers to must
/// outlive it.
std::unique_ptr<Actuator> make_actuator(const description::Model& model, std::size_t device, Mount mount);

}  // namespace cohort::actuation
