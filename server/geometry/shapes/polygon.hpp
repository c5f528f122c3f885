#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "server/description/shape.hpp"

/// Simple polygons in a plane, as lists of their corners in either direction. All decisions are exact.
namespace cohort::geometry {

/// Clipping ears takes a time that may grow with the cube of the number of points.
inline constexpr std::size_t most_polygon_points = 1000;

/// Returns the polygon without its holes, extruded along z from 0 to `height`, as a closed mesh. Points on a straight
/// line between others are left out. The holes are inside the polygon, and none is inside of another. Throws
/// std::invalid_argument with the flaw of a polygon that is not simple, has no area, or has more than
/// `most_polygon_points`.
///
/// Ear clipping (Meisters, "Polygons have ears", American Mathematical Monthly 82(6), 1975). Before it, a cut from each
/// hole to the nearest corner that is visible from there makes one polygon of all.
description::TriangleMesh extruded(const std::vector<Eigen::Vector2d>& polygon,
                                   const std::vector<std::vector<Eigen::Vector2d>>& holes, double height);

enum class PolygonPlace { apart, inside, around, crossing };

/// Returns where a simple polygon is, relative to another one. Those that touch each other are crossing.
PolygonPlace place_of_polygon(const std::vector<Eigen::Vector2d>& polygon, const std::vector<Eigen::Vector2d>& other);

}  // namespace cohort::geometry
