// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Target position of one joint [rad] or [m].
class PositionMotor final : public ActuatorOf<description::PositionMotor> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override {
    const char* unit = facts_of(mount_.joint(device_.joint).type).slides ? "m" : "rad";
    const description::JointAxis& axis = mount_.joint(device_.joint).axis;
    return {{device_.name + "/0/position", unit, 1, axis.lower, axis.upper, std::clamp(0.0, axis.lower, axis.upper)}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_joint_target(mount_.body, JointId{device_.joint}, physics::JointTarget::position(values[0]));
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::PositionMotor& motor, const Mount& mount) {
  return std::make_unique<PositionMotor>(motor, mount);
}

}  // namespace cohort::actuation
