// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// The command channels of a vehicle on wheels or tracks: a twist in its plane.
template <class Drive>
std::vector<Channel> twist_channels(const Drive& drive) {
  return {{drive.name + "/0/linear", "m/s", 1, -drive.max_linear, drive.max_linear, 0.0},
          {drive.name + "/0/angular", "rad/s", 1, -drive.max_angular, drive.max_angular, 0.0}};
}

/// Sets the wheel speeds for rolling when the vehicle moves with `linear` [m/s] and `angular` [rad/s].
template <class Drive>
void set_wheel_speeds(const Drive& drive, const Mount& mount, double linear, double angular) {
  const double difference = 0.5 * drive.wheel_separation * angular;
  for (const std::size_t joint : drive.left_joints)
    mount.world.set_joint_target(mount.body, JointId{joint},
                                 physics::JointTarget::velocity((linear - difference) / drive.wheel_radius));
  for (const std::size_t joint : drive.right_joints)
    mount.world.set_joint_target(mount.body, JointId{joint},
                                 physics::JointTarget::velocity((linear + difference) / drive.wheel_radius));
}

}  // namespace cohort::actuation
