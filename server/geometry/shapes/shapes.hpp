#pragma once

#include <Eigen/Core>
#include <limits>

#include "server/core/pose.hpp"
#include "server/geometry/shapes/bounds.hpp"

/// Closed forms on the shapes of a description. Pure functions, callable from any thread.
namespace cohort::geometry {

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

/// The ray and the result are in the shape's own frame. An entry further than `range` may be left out. Of a mesh this
/// makes a MeshSurface first: for more than one ray, keep that.
RayEntry cast_ray(const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double range = std::numeric_limits<double>::infinity());

}  // namespace cohort::geometry
