// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/geometry/shapes/bounds.hpp"

/// Rays on a height map.
namespace cohort::geometry {

/// Returns the tightest bounds at X_WC. They have no lower end along the height map's own z axis, because everything
/// below the surface is solid.
Bounds bounds_of(const description::HeightGrid& grid, const Pose& X_WC);

/// Returns where a ray enters, at most at `range`: through the surface, or through a side of the rectangle below it.
/// The rules of cast_ray of a Shape apply.
RayEntry cast_ray(const description::HeightGrid& grid, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double range);

}  // namespace cohort::geometry
