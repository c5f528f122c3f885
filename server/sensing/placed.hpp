// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/sensing/sensor.hpp"

/// Common functions of sensors with a pose S on a link.
namespace cohort::sensing {

template <class Posed>
Pose pose_of(const Posed& sensor, const Mount& mount) {
  return mount.world.link_pose(mount.body, LinkId{sensor.link}) * sensor.X_LS;
}

/// Returns the velocity of the origin of S in world axes [m/s].
template <class Posed>
Eigen::Vector3d velocity_of(const Posed& sensor, const Mount& mount) {
  const physics::Twist twist = mount.world.link_twist(mount.body, LinkId{sensor.link});
  const Eigen::Vector3d p_LS_W =
      mount.world.link_pose(mount.body, LinkId{sensor.link}).orientation * sensor.X_LS.position;
  return twist.linear_W + twist.angular_W.cross(p_LS_W);
}

/// Returns the acceleration of the origin of S minus gravity, in S [m/s^2], at the end of the last step.
template <class Posed>
Eigen::Vector3d proper_acceleration_of(const Posed& sensor, const Mount& mount) {
  const Eigen::Vector3d a_W = mount.world.link_acceleration(mount.body, LinkId{sensor.link}, sensor.X_LS.position);
  return pose_of(sensor, mount).orientation.conjugate() * (a_W - mount.description.gravity);
}

inline void write(const Eigen::Vector3d& v, std::span<double> values) {
  for (std::size_t i = 0; i < 3; ++i) values[i] = v[static_cast<Eigen::Index>(i)];
}

/// Writes x y z w; of the two quaternions of a rotation, the one with w >= 0.
inline void write(const Eigen::Quaterniond& q, std::span<double> values) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < 4; ++i) values[i] = sign * q.coeffs()[static_cast<Eigen::Index>(i)];
}

}  // namespace cohort::sensing
