// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Velocity of a propeller, as reported by its motor controller.
class RotorEncoder final : public SensorOf<description::Rotor> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/velocity", "rad/s", 1, device_.min_velocity, device_.max_velocity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    values[0] = mount_.world.device_state(mount_.body, mount_.device, 0).velocity;
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Rotor& rotor, const Mount& mount) {
  return std::make_unique<RotorEncoder>(rotor, mount);
}

}  // namespace cohort::sensing
