// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Velocity of one joint [rad/s] or [m/s].
class VelocityMotor final : public ActuatorOf<description::VelocityMotor> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override {
    const char* unit = facts_of(mount_.joint(device_.joint).type).slides ? "m/s" : "rad/s";
    return {{device_.name + "/0/velocity", unit, 1, -device_.max_velocity, device_.max_velocity, 0.0}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_joint_target(mount_.body, JointId{device_.joint}, physics::JointTarget::velocity(values[0]));
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::VelocityMotor& motor, const Mount& mount) {
  return std::make_unique<VelocityMotor>(motor, mount);
}

}  // namespace cohort::actuation
