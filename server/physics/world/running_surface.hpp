#pragma once

#include <Eigen/Geometry>

namespace cohort::physics {

/// How the surface of a solid runs round it, as that of a wheel that turns about `axis_W` would: everywhere as fast,
/// at right angles to the axis.
struct RunningSurface {
  Eigen::Vector3d axis_W = Eigen::Vector3d::Zero();  ///< unit; zero: it is no belt
  double velocity = 0.0;                             ///< [m/s]

  bool is_belt() const { return !axis_W.isZero(0.0); }
  /// Against the solid, where its surface looks towards `outward_W`, a unit vector; nothing on the sides of the belt.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& outward_W) const {
    constexpr double upright = 1e-3;  // an axis that stands on the surface, up to this, is none of a belt's [rad]
    const Eigen::Vector3d along_W = axis_W.cross(outward_W);
    const double length = along_W.norm();
    if (velocity == 0.0 || length <= upright) return Eigen::Vector3d::Zero();
    return velocity / length * along_W;
  }
};

}  // namespace cohort::physics
