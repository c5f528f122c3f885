// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Position and velocity of one joint, exact.
class JointEncoder final : public SensorOf<description::JointEncoder> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    const description::Joint& joint = mount_.joint(device_.joint);
    const std::string unit = facts_of(joint.type).slides ? "m" : "rad";
    return {{device_.name + "/0/position", unit, 1, joint.axis.lower, joint.axis.upper, 0.0},
            {device_.name + "/0/velocity", unit + "/s", 1, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const physics::JointState joint = mount_.world.joint_state(mount_.body, JointId{device_.joint});
    values[0] = joint.position;
    values[1] = joint.velocity;
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::JointEncoder& encoder, const Mount& mount) {
  return std::make_unique<JointEncoder>(encoder, mount);
}

}  // namespace cohort::sensing
