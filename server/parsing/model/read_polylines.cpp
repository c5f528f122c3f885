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

// Adds a polyline to those that do not contain each other.
void add_apart(ReadPolyline added, const SdfReport* report, std::vector<ReadPolyline>& polylines) {
  const auto leave_out = [&](const Element* element) {
    if (report != nullptr)
      report->warning(element, "lies inside another <polyline>; holes are not supported, and this one is filled");
  };
  std::vector<ReadPolyline> apart;
  for (ReadPolyline& other : polylines) {
    switch (geometry::place_of_polygon(added.polyline.points, other.polyline.points)) {
      case geometry::PolygonPlace::crossing:
        throw PolylineFlaw(added.element, "crosses or touches another <polyline> of the <geometry>");
      case geometry::PolygonPlace::inside: return leave_out(added.element);
      case geometry::PolygonPlace::around: leave_out(other.element); break;
      case geometry::PolygonPlace::apart: apart.push_back(other); break;
    }
  }
  apart.push_back(std::move(added));
  polylines = std::move(apart);
}

TriangleMesh extruded_polyline(const ReadPolyline& read) {
  try {
    return geometry::extruded(read.polyline.points, read.polyline.height);
  } catch (const std::invalid_argument& error) {
    throw PolylineFlaw(read.element, error.what());
  }
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
    static_cast<void>(extruded_polyline({element, *polyline}));  // it must be valid to be compared
    add_apart({element, *polyline}, report, polylines);
  }
  TriangleMesh mesh;
  for (const ReadPolyline& each : polylines) append(extruded_polyline(each), mesh);
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
