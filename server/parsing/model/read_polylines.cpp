// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/read_polylines.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "server/geometry/shapes/convex_hull.hpp"
#include "server/geometry/shapes/polygon.hpp"

namespace cohort::parsing {
namespace {

struct ReadPolyline {
  const Element* element;
  Polyline polyline;
  int depth = 0;  // number of others around it; if it is odd, this is a hole
};

// Returns nothing if a number is NaN.
std::optional<Polyline> read_polyline(const Element& element) {
  Polyline polyline;
  for (const Element* const point : children_of(element, "point")) {
    polyline.points.push_back(point->vector().head<2>());
    if (polyline.points.back().hasNaN()) return std::nullopt;
    if (!polyline.points.back().allFinite()) throw PolylineFlaw(point, "expected finite coordinates");
  }
  polyline.height = element.real("height");
  if (std::isnan(polyline.height)) return std::nullopt;
  if (polyline.height <= 0.0 || std::isinf(polyline.height))
    throw PolylineFlaw(element.child("height"), "expected a size > 0 m");
  return polyline;
}

// Appends the mesh of one polyline to those of others.
void append(const TriangleMesh& one, TriangleMesh& all) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
  for (const auto& [a, b, c] : one.triangles) all.triangles.push_back({first + a, first + b, first + c});
}

TriangleMesh extruded_polyline(const ReadPolyline& read, const std::vector<std::vector<Eigen::Vector2d>>& holes = {}) {
  try {
    return geometry::extruded(read.polyline.points, holes, read.polyline.height);
  } catch (const std::invalid_argument& error) {
    throw PolylineFlaw(read.element, error.what());
  }
}

// Counts the others around the last polyline, and counts it for the others inside it.
void nest(std::vector<ReadPolyline>& polylines) {
  ReadPolyline& added = polylines.back();
  for (ReadPolyline& other : polylines) {
    if (&other == &added) continue;
    switch (geometry::place_of_polygon(added.polyline.points, other.polyline.points)) {
      case geometry::PolygonPlace::crossing:
        throw PolylineFlaw(added.element, "crosses or touches another <polyline> of the <geometry>");
      case geometry::PolygonPlace::inside: ++added.depth; break;
      case geometry::PolygonPlace::around: ++other.depth; break;
      case geometry::PolygonPlace::apart: break;
    }
  }
}

// Returns the holes of a polyline: those inside it that are inside no other hole of it.
std::vector<std::vector<Eigen::Vector2d>> holes_of(const ReadPolyline& outer,
                                                   const std::vector<ReadPolyline>& polylines,
                                                   const SdfReport* report) {
  std::vector<std::vector<Eigen::Vector2d>> holes;
  for (const ReadPolyline& each : polylines) {
    if (each.depth != outer.depth + 1 ||
        geometry::place_of_polygon(each.polyline.points, outer.polyline.points) != geometry::PolygonPlace::inside)
      continue;
    if (report != nullptr && each.polyline.height != outer.polyline.height)
      report->warning(each.element, "is a hole of another <polyline>; it has the height of that one");
    holes.push_back(each.polyline.points);
  }
  return holes;
}

}  // namespace

std::optional<TriangleMesh> read_polylines(const Element& geometry, bool convex, const SdfReport* report) {
  std::vector<ReadPolyline> polylines;
  std::size_t points = 0;
  for (const Element* const element : children_of(geometry, "polyline")) {
    const std::optional<Polyline> polyline = read_polyline(*element);
    if (!polyline) return std::nullopt;
    points += polyline->points.size();
    if (points > geometry::most_polygon_points)
      throw PolylineFlaw(element, "expected at most " + std::to_string(geometry::most_polygon_points) +
                                      " points in all polylines of a <geometry>");
    polylines.push_back({element, *polyline});
    static_cast<void>(extruded_polyline(polylines.back()));  // it must be valid to be compared
    nest(polylines);
  }
  TriangleMesh mesh;
  for (const ReadPolyline& each : polylines)
    if (each.depth % 2 == 0) append(extruded_polyline(each, holes_of(each, polylines, report)), mesh);
  if (convex) {
    try {
      mesh = geometry::convex_hull(mesh.vertices);
    } catch (const std::invalid_argument&) {
      throw PolylineFlaw(polylines.front().element, "is flat; its convex hull must have a volume");
    }
  }
  for (ReadPolyline& each : polylines) mesh.polylines.push_back(std::move(each.polyline));
  return mesh;
}

}  // namespace cohort::parsing
