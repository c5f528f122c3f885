// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>

#include "server/core/pose.hpp"
#include "server/geometry/shapes/bounds.hpp"

/// Closed forms for the shapes of a description. Pure functions, callable from any thread.
namespace cohort::geometry {

/// Returns the tightest bounds of `shape` at X_WC. Those of a plane are all of space, and those of a height map include
/// everything below it.
Bounds bounds_of(const Shape& shape, const Pose& X_WC);

/// Returns the bounds of the disc of `radius` around the origin in the xy plane of S, slightly enlarged against
/// rounding: the region that rays in that plane can reach.
Bounds bounds_of_disc(const Pose& X_WS, double radius);

/// Returns the radius of the smallest ball around the shape's origin that holds it [m]; infinite for planes and height
/// maps.
double radius_of(const Shape& shape);

/// Returns half the thickness of the shape [m]: a point outside that moves by at most this distance does not pass its
/// middle. For a mesh, it is that of its bounds; infinite for planes and height maps.
double half_thickness_of(const Shape& shape);

/// Returns where a ray enters; the ray and the result are in the shape's own frame. An entry beyond `range` may be
/// omitted. For a mesh, each call makes a MeshSurface first; for more than one ray, keep one instead.
RayEntry cast_ray(const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double range = std::numeric_limits<double>::infinity());

}  // namespace cohort::geometry
