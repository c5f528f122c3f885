// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <variant>

#include "server/description/shape.hpp"

/// Properties of all shapes: their bounds, and where a ray enters.
namespace cohort::geometry {

using description::Shape;

/// Returns whether a shape is ground: solid without limit below its surface.
inline bool is_ground(const Shape& shape) {
  return std::holds_alternative<description::Plane>(shape) || std::holds_alternative<description::Heightmap>(shape);
}

/// Axis-aligned box in the world frame [m]; may be infinite.
struct Bounds {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;

  bool overlaps(const Bounds& other) const {
    return (lower.array() <= other.upper.array()).all() && (other.lower.array() <= upper.array()).all();
  }
  void include(const Bounds& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  /// Returns an upper bound on the distance, along a ray of unit direction, at which the ray can be inside the box [m].
  double last_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  Bounds grown_by(double margin) const { return {lower.array() - margin, upper.array() + margin}; }
};

/// The point at which a ray enters a solid. `distance`: along the unit direction, 0 if it starts inside, infinite if it
/// misses. `normal`: outward unit normal of the surface there, undefined if the ray starts inside or misses.
struct RayEntry {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

}  // namespace cohort::geometry
