// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cohort::geometry {

/// Returns the corners of the convex hull of points in a plane, counter-clockwise (A. M. Andrew, "Another efficient
/// algorithm for convex hulls in two dimensions", Information Processing Letters 9(5), 1979). Returns fewer than three
/// if the points lie on a line.
std::vector<Eigen::Vector2d> convex_hull_2d(std::vector<Eigen::Vector2d> points);

}  // namespace cohort::geometry
