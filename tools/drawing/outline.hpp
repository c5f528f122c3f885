#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/drawing/run_trace.hpp"

namespace cohort::tool {

/// A solid as it is seen: the convex hull of its corners, or a circle if it has none [m].
struct Outline {
  std::vector<Eigen::Vector2d> corners_V;
  Eigen::Vector2d centre_V = Eigen::Vector2d::Zero();
  double radius = 0.0;
};

/// Of a plane and of a height map, a circle without size.
Outline outline_of(const TracedSolid& solid);

}  // namespace cohort::tool
