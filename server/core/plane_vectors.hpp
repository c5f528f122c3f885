// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// Vectors of a plane seen from above: x to the front, y to the left.
namespace cohort {

/// Returns the z component of the cross product of (a, 0) and (b, 0): positive if b is to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the vector rotated by 90° to the left.
inline Eigen::Vector2d left_of(const Eigen::Vector2d& vector) { return {-vector.y(), vector.x()}; }

}  // namespace cohort
