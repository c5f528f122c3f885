#include "server/actuation/velocity_motor.hpp"

namespace cohort::actuation {

std::vector<Channel> VelocityMotor::channels() const {
  const char* unit = joint_.type == description::JointType::prismatic ? "m/s" : "rad/s";
  return {{motor_.name + "/0/velocity", unit, 1, -motor_.max_velocity, motor_.max_velocity, 0.0}};
}

void VelocityMotor::apply(std::span<const double> values) {
  mount_.world.set_joint_velocity_target(mount_.body, motor_.joint, values[0]);
}

}  // namespace cohort::actuation
