#pragma once

#include <optional>
#include <vector>

#include "server/description/model.hpp"

namespace cohort::geometry {

/// The shadow of a shape on the ground: a rectangle with rounded corners, which a circle is too.
struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< unit vector along the rectangle's first edge
  Eigen::Vector2d half = Eigen::Vector2d::Zero();   ///< half the edges of the rectangle
  double radius = 0.0;                              ///< reaches this far around it
  double lowest = 0.0;                              ///< z of the shape
  double highest = 0.0;

  /// From a point to the edge; 0 inside.
  double distance(const Eigen::Vector2d& point) const;
  /// Half the edges of the least upright rectangle around it.
  Eigen::Vector2d half_extent() const;
};

/// Of a shape whose pose in the world is X_WC: exact for spheres, for capsules, and for boxes and cylinders that stand
/// upright; a rectangle around the shadow if they are tilted, and of a mesh the least one; around that of an ellipsoid,
/// one with rounded ends. None for a plane and a height map.
std::optional<Footprint> footprint_of(const description::Shape& shape, const Pose& X_WC);

/// Of all collisions of a model whose pose in the world is X_WM.
std::vector<Footprint> footprints_of(const description::Model& model, const Pose& X_WM);

}  // namespace cohort::geometry
