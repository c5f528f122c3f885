// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Torque or force on one joint [N m] or [N].
class EffortMotor final : public ActuatorOf<description::EffortMotor> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override {
    const char* unit = facts_of(mount_.joint(device_.joint).type).slides ? "N" : "N m";
    return {{device_.name + "/0/effort", unit, 1, -device_.max_effort, device_.max_effort, 0.0}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_joint_target(mount_.body, JointId{device_.joint}, physics::JointTarget::effort(values[0]));
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::EffortMotor& motor, const Mount& mount) {
  return std::make_unique<EffortMotor>(motor, mount);
}

}  // namespace cohort::actuation
