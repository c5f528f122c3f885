#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "server/description/shape.hpp"

/// Simple polygons in a plane, as lists of their corners in either direction. All decisions are exact.
namespace cohort::geometry {

/// Clipping ears takes a time that may grow with the cube of the number of points.
inline constexpr std::size_t most_polygon_points = 1000;

/// Returns the polygon extruded along z, from 0 to `height`, as a closed mesh. Points on a straight line between others
/// are left out. Throws std::invalid_argument with the flaw of a polygon that is not simple, has no area, or has
/// more than `most_polygon_points`.
///
/// Ear clipping (Meisters, "Polygons have ears", American Mathematical Monthly 82(6), 1975).
description::TriangleMesh extruded(const std::vector<Eigen::Vector2d>& polygon, double height);

enum class PolygonPlace { apart, inside, around, crossing };

/// Returns where a simple polygon is, relative to another one. Those that touch each other are crossing.
PolygonPlace place_of_polygon(const std::vector<Eigen::Vector2d>& polygon, const std::vector<Eigen::Vector2d>& other);

}  // namespace cohort::geometry
