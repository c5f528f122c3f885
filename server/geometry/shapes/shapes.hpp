#pragma once

#include <Eigen/Core>
#include <limits>
#include <variant>

#include "server/core/pose.hpp"
#include "server/description/shape.hpp"

/// Closed forms on the shapes of a description. Pure functions, callable from any thread.
namespace cohort::geometry {

using description::Shape;

/// Whether a shape is what everything stands on: solid without end below its surface.
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
  /// No point within is further along a ray of unit direction than this [m].
  double last_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  Bounds grown_by(double margin) const { return {lower.array() - margin, upper.array() + margin}; }
};

/// The tightest bounds of `shape` at X_WC; those of a plane are all of space, and a height map has all that is below
/// it.
Bounds bounds_of(const Shape& shape, const Pose& X_WC);

/// Of the disc of `radius` around the origin in the xy plane of S, a little thickened against rounding: what rays in
/// that plane can reach.
Bounds bounds_of_disc(const Pose& X_WS, double radius);

/// Of the smallest ball around the shape's origin that holds it [m]; infinite for planes and height maps.
double radius_of(const Shape& shape);

/// Half of how thin the shape is [m]: a point that moves no further from outside is not beyond its middle. Of a mesh
/// that of its bounds; infinite for planes and height maps.
double half_thickness_of(const Shape& shape);

/// Where a ray enters a solid: `distance` along the unit direction, 0 if it starts inside, infinite if it misses.
/// `normal`: outward unit normal of the surface there, undefined if it starts inside or misses.
struct RayEntry {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// The ray and the result are in the shape's own frame. An entry further than `range` may be left out. Of a mesh this
/// makes a MeshSurface first: for more than one ray, keep that.
RayEntry cast_ray(const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double range = std::numeric_limits<double>::infinity());

}  // namespace cohort::geometry
