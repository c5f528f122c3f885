#include "server/actuation/effort_motor.hpp"

namespace cohort::actuation {

std::vector<Channel> EffortMotor::channels() const {
  const char* unit = joint_.type == description::JointType::prismatic ? "N" : "N m";
  return {{motor_.name + "/0/effort", unit, 1, -motor_.max_effort, motor_.max_effort, 0.0}};
}

void EffortMotor::apply(std::span<const double> values) {
  mount_.world.set_joint_effort_target(mount_.body, motor_.joint, values[0]);
}

}  // namespace cohort::actuation
