#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/core/channel.hpp"
#include "server/core/hash.hpp"
#include "server/core/infinity.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/world.hpp"
#include "server/emission/emitters.hpp"
#include "server/gripping/grippers.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/sensing/shared_view.hpp"

namespace cohort::sensing {

/// Where a sensor is mounted, and what it senses. All that it refers to must outlive the sensor.
struct Mount {
  const physics::World& world;
  const emission::Emitters& emitters;
  const description::World& description;
  const gripping::Grippers& grippers;
  SharedViews& views;
  BodyId body;         ///< the robot's, which is its index among the description's instances
  DeviceId device;     ///< of the robot's model
  std::uint64_t seed;  ///< of the experiment; with the robot's name it fixes what is random

  const std::string& robot_name() const { return description.instances[body.value].name; }
  const description::Model& model() const { return description.models[description.instances[body.value].model]; }
  const description::Joint& joint(std::size_t index) const { return model().joints[index]; }
};

/// Reads the world. One object for each device of each robot.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// The channels that `sense` fills, in order.
  virtual std::vector<Channel> channels() const = 0;
  /// Writes one value for each float64 of the channels, as they are: what disturbs them comes after (SignalChain). A
  /// pure function of the state of the world and of the sensor, and of the tick; runs at once with other sensors, from
  /// any thread.
  virtual void sense(std::uint64_t tick, std::span<double> values) const = 0;

  /// Whether it asks for joint_wrench or link_acceleration of its robot's body, which the world then has to keep.
  virtual bool needs_record() const { return false; }

  /// Of a sensor with a shared view: tells the view that `sense` will need it. Called for those that measure at a tick,
  /// on one thread and in the order of the robots, before the views are updated and any sensor senses there.
  virtual bool has_shared_view() const { return false; }
  virtual void ask_shared_view() {}

  /// Of a sensor with a memory: takes note of this tick, before it senses and whether it is asked or not.
  /// `was_delivered`: the robot was given what was sensed at the tick before. Called again at the same tick, when
  /// something has been changed from outside, it takes note of this tick anew.
  virtual void remember(std::uint64_t /*tick*/, bool /*was_delivered*/) {}
  /// Whether the robot can do nothing in the step to come but what is neutral.
  virtual bool disables_robot() const { return false; }
  /// What it remembers.
  virtual void hash(StateHash& /*hash*/) const {}
  virtual void save(SnapshotWriter& /*writer*/) const {}
  virtual void restore(SnapshotReader& /*reader*/) {}
};

}  // namespace cohort::sensing
