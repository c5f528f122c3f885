// SPDX-License-Identifier: Apache-2.0
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

/// The mount of a sensor, and the objects that it senses. They must outlive the sensor.
struct Mount {
  const physics::World& world;
  const emission::Emitters& emitters;
  const description::World& description;
  const gripping::Grippers& grippers;
  SharedViews& views;
  BodyId body;         ///< the robot's body; also its index among the description's instances
  DeviceId device;     ///< index in the robot's model
  std::uint64_t seed;  ///< seed of the experiment; with the robot's name it determines all random numbers

  const std::string& robot_name() const { return description.instances[body.value].name; }
  const description::Model& model() const { return description.models[description.instances[body.value].model]; }
  const description::Joint& joint(std::size_t index) const { return model().joints[index]; }
};

/// A sensor that reads the world: one object for each device of each robot.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Returns the channels that `sense` fills, in order.
  virtual std::vector<Channel> channels() const = 0;
  /// Writes one exact value for each float64 of the channels; errors are added later (SignalChain). A pure function of
  /// the state of the world and of the sensor, and of the tick. May run concurrently with other sensors, on any thread.
  virtual void sense(std::uint64_t tick, std::span<double> values) const = 0;

  /// Returns true if the sensor uses joint_wrench or link_acceleration of its robot's body. The world must then record
  /// these.
  virtual bool needs_record() const { return false; }

  /// For a sensor with a shared view: tells the view that `sense` will need it. Called for the sensors that measure at
  /// a tick, on one thread and in the order of the robots, before the views are updated and before any sensor senses.
  virtual bool has_shared_view() const { return false; }
  virtual void ask_shared_view() {}

  /// For a sensor with a memory: notes this tick, before it senses and even if the robot is not due. `was_delivered`:
  /// the robot received the readings of the previous tick. A second call at the same tick, after a change from outside,
  /// replaces the first one.
  virtual void remember(std::uint64_t /*tick*/, bool /*was_delivered*/) {}
  /// Returns true if the sensor, such as an empty battery, disables the robot: its command is neutral in the next step.
  virtual bool disables_robot() const { return false; }
  /// Adds its memory to the hash.
  virtual void hash(StateHash& /*hash*/) const {}
  virtual void save(SnapshotWriter& /*writer*/) const {}
  virtual void restore(SnapshotReader& /*reader*/) {}
};

}  // namespace cohort::sensing
