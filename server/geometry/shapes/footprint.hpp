// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "server/description/model.hpp"

namespace cohort::geometry {

/// The projection of a shape onto the ground: a rectangle with rounded corners, or a circle.
struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< unit vector along the rectangle's first edge
  Eigen::Vector2d half = Eigen::Vector2d::Zero();   ///< half the edges of the rectangle [m]
  double radius = 0.0;                              ///< distance by which the outline extends beyond the rectangle [m]
  double lowest = 0.0;                              ///< least z of the shape [m]
  double highest = 0.0;                             ///< greatest z of the shape [m]

  /// Returns the distance from a point to the edge; 0 inside.
  double distance(const Eigen::Vector2d& point) const;
  /// Returns half the edges of its axis-aligned bounding rectangle.
  Eigen::Vector2d half_extent() const;
};

/// Returns the footprint of a shape whose pose in the world is X_WC. It is exact for spheres, capsules, and upright
/// boxes and cylinders. For tilted boxes and cylinders it is a rectangle around the projection, and for a mesh the one
/// of least area. For an ellipsoid it is a rectangle with rounded ends around the projection. Planes and height maps
/// have none.
std::optional<Footprint> footprint_of(const description::Shape& shape, const Pose& X_WC);

/// Returns the footprints of all collisions of a model whose pose in the world is X_WM.
std::vector<Footprint> footprints_of(const description::Model& model, const Pose& X_WM);

}  // namespace cohort::geometry
