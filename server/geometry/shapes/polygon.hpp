// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "server/description/shape.hpp"

/// Simple polygons in a plane, as lists of their corners in either direction. All decisions are exact.
namespace cohort::geometry {

/// Greatest number of points of a polygon, since the time for ear clipping may grow with its cube.
inline constexpr std::size_t most_polygon_points = 1000;

/// Returns the polygon without its holes, extruded along z from 0 to `height`, as a closed mesh. Points on a straight
/// line between others are left out. The holes must be inside the polygon, and none inside another. Throws
/// std::invalid_argument, with a description of the problem, for a polygon that is not simple, has no area, or has more
/// than `most_polygon_points`.
///
/// Ear clipping (Meisters, "Polygons have ears", American Mathematical Monthly 82(6), 1975). First, a cut from each
/// hole to the nearest visible corner joins all outlines into one polygon.
description::TriangleMesh extruded(const std::vector<Eigen::Vector2d>& polygon,
                                   const std::vector<std::vector<Eigen::Vector2d>>& holes, double height);

enum class PolygonPlace { apart, inside, around, crossing };

/// Returns the position of a simple polygon relative to another one. Polygons that touch each other count as crossing.
PolygonPlace place_of_polygon(const std::vector<Eigen::Vector2d>& polygon, const std::vector<Eigen::Vector2d>& other);

}  // namespace cohort::geometry
