// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {

/// The arm that `with_arm` adds.
inline constexpr std::size_t arm_link = 2;
inline constexpr std::size_t elevation_joint = 1;
inline constexpr double arm_length = 0.1;  // from the elevation joint to the jaw [m]

/// Returns the tracked robot with an arm at the front of its turret. The arm is horizontal at joint position 0, and a
/// motor lifts it towards negative positions.
inline description::Model with_arm(double max_effort = 2.0, double arm_mass = 0.05, double rotor_inertia = 0.0) {
  description::Model model = tracked_robot();
  model.name = "lifter";
  description::Inertial inertial = solid_box(arm_mass, {arm_length, 0.02, 0.02});
  inertial.X_LI.position.x() = 0.5 * arm_length;
  model.links.push_back({"arm", {{0.03, 0, 0.075}}, inertial, {}});
  description::Joint joint;
  joint.name = "elevation";
  joint.type = description::JointType::revolute;
  joint.parent = 1;
  joint.child = arm_link;
  joint.axis.direction = Eigen::Vector3d::UnitY();
  joint.axis.lower = -1.6;
  joint.axis.upper = 0.8;
  model.joints.push_back(joint);
  model.devices.push_back(description::VelocityMotor{"elevation", elevation_joint, 1.0, max_effort, rotor_inertia});
  return model;
}

}  // namespace cohort::test
