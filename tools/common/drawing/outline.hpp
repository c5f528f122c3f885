// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/common/drawing/run_trace.hpp"

namespace cohort::tool {

/// The visible outline of a solid: the convex hull of its corners, or a circle if it has none [m].
struct Outline {
  std::vector<Eigen::Vector2d> corners_V;
  Eigen::Vector2d centre_V = Eigen::Vector2d::Zero();
  double radius = 0.0;
};

/// Returns the outline of a solid; for a plane or a height map, a circle with radius zero.
Outline outline_of(const TracedSolid& solid);

}  // namespace cohort::tool
