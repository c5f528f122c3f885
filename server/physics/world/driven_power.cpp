// SPDX-License-Identifier: Apache-2.0
#include "server/physics/world/driven_power.hpp"

#include <algorithm>

namespace cohort::physics {

double driven_power(const World& world, BodyId body, const description::Model& model) {
  double power = 0.0;
  const auto add = [&](const auto& state) { power += std::max(0.0, state.effort * state.velocity); };
  for (const description::Device& device : model.devices)
    for (const description::MotorLimits& motor : description::motor_limits(device))
      add(world.joint_state(body, JointId{motor.joint}));
  for (std::size_t device = 0; device < model.devices.size(); ++device)
    for (std::size_t output = 0; output < description::output_count(model.devices[device]); ++output)
      add(world.device_state(body, DeviceId{device}, output));
  return power;
}

}  // namespace cohort::physics
