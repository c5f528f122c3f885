#include "server/actuation/position_motor.hpp"

#include <algorithm>

namespace cohort::actuation {

std::vector<Channel> PositionMotor::channels() const {
  const char* unit = joint_.type == description::JointType::prismatic ? "m" : "rad";
  const description::JointAxis& axis = joint_.axis;
  return {{motor_.name + "/0/position", unit, 1, axis.lower, axis.upper, std::clamp(0.0, axis.lower, axis.upper)}};
}

void PositionMotor::apply(std::span<const double> values) {
  mount_.world.set_joint_position_target(mount_.body, motor_.joint, values[0]);
}

}  // namespace cohort::actuation
