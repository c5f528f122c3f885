// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace cohort::physics {

/// Returns the rotation by |v| about v, for any v [rad].
inline Eigen::Quaterniond rotation_by(const Eigen::Vector3d& v) {
  const double half_squared = 0.25 * v.squaredNorm();
  double cosine = 0.0;
  double sine_over_half = 0.0;  // sin(x) / x of the half angle x
  // For the usual rotation in one step, less than half a radian, the Taylor series are exact to the last bits.
  constexpr double small = 0.0625;
  if (half_squared < small) {
    const double x = half_squared;
    cosine =
        1.0 - x / 2.0 * (1.0 - x / 12.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0 * (1.0 - x / 90.0 * (1.0 - x / 132.0)))));
    sine_over_half =
        1.0 - x / 6.0 * (1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0 * (1.0 - x / 110.0 * (1.0 - x / 156.0)))));
  } else {
    const double half = std::sqrt(half_squared);
    cosine = std::cos(half);
    sine_over_half = std::sin(half) / half;
  }
  const Eigen::Vector3d axis = 0.5 * sine_over_half * v;
  return {cosine, axis.x(), axis.y(), axis.z()};
}

/// Returns the rotation vector of a small rotation.
inline Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) { return (q.w() < 0.0 ? -2.0 : 2.0) * q.vec(); }

/// Returns the rotation by `angle` about a unit vector.
inline Eigen::Quaterniond rotation_about(const Eigen::Vector3d& axis, double angle) {
  const double sine = std::sin(0.5 * angle);
  return {std::cos(0.5 * angle), sine * axis.x(), sine * axis.y(), sine * axis.z()};
}

}  // namespace cohort::physics
