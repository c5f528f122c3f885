// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace cohort::physics {

/// The surface velocity of a solid with a belt. The surface moves as that of a wheel turning about `axis_W` would: with
/// the same speed everywhere, perpendicular to the axis.
struct RunningSurface {
  Eigen::Vector3d axis_W = Eigen::Vector3d::Zero();  ///< unit; zero: not a belt
  double velocity = 0.0;                             ///< [m/s]

  bool is_belt() const { return !axis_W.isZero(0.0); }
  /// Returns the velocity relative to the solid where its surface faces `outward_W`, a unit vector; zero on the sides
  /// of the belt.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& outward_W) const {
    constexpr double upright = 1e-3;  // within this angle of the axis, a surface is the side of a belt [rad]
    const Eigen::Vector3d along_W = axis_W.cross(outward_W);
    const double length = along_W.norm();
    if (velocity == 0.0 || length <= upright) return Eigen::Vector3d::Zero();
    return velocity / length * along_W;
  }
};

}  // namespace cohort::physics
