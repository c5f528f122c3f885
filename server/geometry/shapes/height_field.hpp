#pragma once

#include "server/geometry/shapes/bounds.hpp"

/// Rays on a height map.
namespace cohort::geometry {

/// The tightest bounds at X_WC; without lower end along the height map's own z axis, since all below is solid.
Bounds bounds_of(const description::HeightGrid& grid, const Pose& X_WC);

/// Where a ray enters, no further than `range`: through the surface, or through a side of the rectangle below it. The
/// rules of cast_ray of a Shape hold.
RayEntry cast_ray(const description::HeightGrid& grid, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double range);

}  // namespace cohort::geometry
