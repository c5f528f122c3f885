// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Torque or force of a joint's motor over the last step.
class TorqueSensor final : public SensorOf<description::TorqueSensor> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    const bool slides = facts_of(mount_.joint(device_.joint).type).slides;
    return {{device_.name + (slides ? "/0/force" : "/0/torque"), slides ? "N" : "N m", 1, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    values[0] = mount_.world.joint_state(mount_.body, JointId{device_.joint}).effort;
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::TorqueSensor& sensor, const Mount& mount) {
  return std::make_unique<TorqueSensor>(sensor, mount);
}

}  // namespace cohort::sensing
