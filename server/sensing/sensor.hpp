#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/core/channel.hpp"
#include "server/description/model.hpp"
#include "server/physics/world.hpp"

namespace cohort::sensing {

/// Where a sensor is mounted.
struct Mount {
  const physics::World& world;
  std::uint32_t body;  ///< the robot's
  std::string robot;   ///< scoped name; with the seed it fixes the noise
  std::uint64_t seed;  ///< of the experiment
};

/// Reads the world. One object for each device of each robot.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// The channels that `sense` fills, in order.
  virtual std::vector<Channel> channels() const = 0;
  /// Writes one value for each float64 of the channels. A pure function of the world's state and the tick; runs at once
  /// with other sensors, from any thread.
  virtual void sense(std::uint64_t tick, std::span<double> values) const = 0;
};

/// The sensor of a device, or null if the device senses nothing. `mount.world` must outlive it.
std::unique_ptr<Sensor> make_sensor(const description::Device& device, const description::Model& model, Mount mount);

}  // namespace cohort::sensing
