// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace cohort::geometry {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

// A sum of numbers without rounding. It is a list of numbers, each smaller than the last bit of the next one. From
// Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates", 1997.
class ExactSum {
 public:
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  int sign() const {
    for (std::size_t i = count_; i-- > 0;)
      if (parts_[i] != 0.0) return parts_[i] > 0.0 ? 1 : -1;
    return 0;
  }

 private:
  void add(double number) {
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = number + parts_[i];
      const double rounded = sum - number;
      parts_[i] = (number - (sum - rounded)) + (parts_[i] - rounded);
      number = sum;
    }
    parts_[count_++] = number;
  }

  std::array<double, 12> parts_{};
  std::size_t count_ = 0;
};

// Returns 1 if c is to the left of the line from a to b, -1 if it is to the right, and 0 if it is on the line.
int side_of(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  constexpr double half_of_last_bit = 0x1p-53;
  constexpr double rounding = (3.0 + 16.0 * half_of_last_bit) * half_of_last_bit;  // Shewchuk, section 4.3
  if (std::abs(left - right) > rounding * (std::abs(left) + std::abs(right))) return left > right ? 1 : -1;
  ExactSum sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.x(), c.y());
  sum.add_product(-c.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(a.y(), c.x());
  sum.add_product(c.y(), b.x());
  return sum.sign();
}

bool is_in_box(const Vector2d& point, const Vector2d& a, const Vector2d& b) {
  return (a.cwiseMin(b).array() <= point.array()).all() && (point.array() <= a.cwiseMax(b).array()).all();
}

// Returns whether two edges have a point in common.
bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  if ((a.cwiseMax(b).array() < c.cwiseMin(d).array()).any() || (c.cwiseMax(d).array() < a.cwiseMin(b).array()).any())
    return false;
  const int of_c = side_of(a, b, c), of_d = side_of(a, b, d), of_a = side_of(c, d, a), of_b = side_of(c, d, b);
  if (of_c * of_d < 0 && of_a * of_b < 0) return true;
  return (of_c == 0 && is_in_box(c, a, b)) || (of_d == 0 && is_in_box(d, a, b)) || (of_a == 0 && is_in_box(a, c, d)) ||
         (of_b == 0 && is_in_box(b, c, d));
}

std::string text_of_point(const Vector2d& point) {
  return "(" + std::to_string(point.x()) + ", " + std::to_string(point.y()) + ")";
}

// Returns the points without repeated ones and without those on a straight line between others.
Points corners_of(Points points) {
  for (std::size_t i = 0; i < points.size() && points.size() > 2;) {
    const std::size_t count = points.size();
    const Vector2d& before = points[(i + count - 1) % count];
    const Vector2d& after = points[(i + 1) % count];
    const Vector2d& point = points[i];
    const bool is_repeated = point == after;
    if (!is_repeated && side_of(before, point, after) != 0) {
      ++i;
      continue;
    }
    if (!is_repeated && before != point && !is_in_box(point, before, after))
      throw std::invalid_argument("the polygon turns back on itself at " + text_of_point(point));
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
    i = i > 0 ? i - 1 : 0;
  }
  return points;
}

void expect_simple(const Points& corners) {
  const std::size_t count = corners.size();
  if (count < 3) throw std::invalid_argument("the polygon has no area; expected three points that are not on a line");
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 2; j < count; ++j)
      if ((j + 1) % count != i && meet(corners[i], corners[i + 1], corners[j], corners[(j + 1) % count]))
        throw std::invalid_argument("the edges of the polygon from " + text_of_point(corners[i]) + " and " +
                                    text_of_point(corners[j]) + " cross or touch each other");
}

bool is_lower(const Vector2d& a, const Vector2d& b) { return std::pair(a.y(), a.x()) < std::pair(b.y(), b.x()); }

// Makes the corners counter-clockwise. The polygon is convex at its lowest corner.
void orient(Points& corners) {
  const auto lowest = static_cast<std::size_t>(std::ranges::min_element(corners, is_lower) - corners.begin());
  const std::size_t count = corners.size();
  if (side_of(corners[(lowest + count - 1) % count], corners[lowest], corners[(lowest + 1) % count]) < 0)
    std::ranges::reverse(corners);
}

using Triangle = std::array<std::uint32_t, 3>;
using Ring = std::vector<std::uint32_t>;  // indices of corners

const char* const too_large = "the polygon cannot be divided into triangles, because its coordinates are too large";

// Returns whether an edge of a ring crosses the way between two corners.
bool is_crossed(const Points& corners, const Ring& ring, std::uint32_t from, std::uint32_t to) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
    if (a == from || b == from || a == to || b == to) continue;
    if (meet(corners[from], corners[to], corners[a], corners[b])) return true;
  }
  return false;
}

// Returns whether a point that is on no edge is in the angle of the polygon at a corner of its counter-clockwise ring.
bool is_in_angle(const Points& corners, const Ring& ring, std::size_t i, const Vector2d& point) {
  const Vector2d& before = corners[ring[(i + ring.size() - 1) % ring.size()]];
  const Vector2d& corner = corners[ring[i]];
  const Vector2d& after = corners[ring[(i + 1) % ring.size()]];
  const bool left_of_first = side_of(before, corner, point) > 0;
  const bool left_of_second = side_of(corner, after, point) > 0;
  return side_of(before, corner, after) >= 0 ? left_of_first && left_of_second : left_of_first || left_of_second;
}

// Cuts from the lowest corner of a clockwise hole, which sees a corner of another ring, to the nearest corner of
// `outer` that is visible from there. No other corner is on the way to that one.
bool cut_to_hole(const Points& corners, const std::vector<Ring>& rings, const Ring& hole, Ring& outer) {
  const auto lowest = std::ranges::min_element(
      hole, [&](std::uint32_t a, std::uint32_t b) { return is_lower(corners[a], corners[b]); });
  const std::uint32_t from = *lowest;
  const auto is_visible = [&](std::uint32_t to) {
    return !is_crossed(corners, outer, from, to) &&
           std::ranges::none_of(rings, [&](const Ring& ring) { return is_crossed(corners, ring, from, to); });
  };
  std::vector<std::size_t> nearest(outer.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = i;
  std::ranges::stable_sort(nearest, {},
                           [&](std::size_t i) { return (corners[outer[i]] - corners[from]).squaredNorm(); });
  for (const std::size_t i : nearest) {
    if (!is_in_angle(corners, outer, i, corners[from]) || !is_visible(outer[i])) continue;
    Ring way(lowest, hole.end());
    way.insert(way.end(), hole.begin(), lowest);
    way.push_back(from);
    way.push_back(outer[i]);
    outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(i) + 1, way.begin(), way.end());
    return true;
  }
  return false;
}

// Returns one ring around the polygon, which is the first ring, and its holes. A hole that sees only other holes waits
// for them.
Ring with_cuts(const Points& corners, const std::vector<Ring>& rings) {
  Ring outer = rings.front();
  std::vector<const Ring*> holes;
  for (std::size_t i = 1; i < rings.size(); ++i) holes.push_back(&rings[i]);
  while (!holes.empty())
    if (std::erase_if(holes, [&](const Ring* hole) { return cut_to_hole(corners, rings, *hole, outer); }) == 0)
      throw std::invalid_argument(too_large);
  return outer;
}

// Returns whether a triangle of three consecutive corners can be cut off.
bool is_ear(const Points& corners, const std::vector<std::uint32_t>& ring, const Triangle& ear) {
  const Vector2d &a = corners[ear[0]], &b = corners[ear[1]], &c = corners[ear[2]];
  if (side_of(a, b, c) <= 0) return false;
  return std::ranges::none_of(ring, [&](std::uint32_t other) {
    const Vector2d& point = corners[other];
    return other != ear[0] && other != ear[1] && other != ear[2] && side_of(a, b, point) >= 0 &&
           side_of(b, c, point) >= 0 && side_of(c, a, point) >= 0;
  });
}

// Returns the triangles of a polygon with counter-clockwise corners.
std::vector<Triangle> triangles_of(const Points& corners, Ring ring) {
  std::vector<Triangle> triangles;
  while (ring.size() > 2) {
    const std::size_t count = ring.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Triangle ear{ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]};
      if (!is_ear(corners, ring, ear)) continue;
      triangles.push_back(ear);
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (ring.size() == count) throw std::invalid_argument(too_large);
  }
  return triangles;
}

// Returns whether a point that is not on the boundary is inside: a ray from it to the right crosses the boundary an odd
// number of times.
bool contains(const Points& polygon, const Vector2d& point) {
  bool is_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (side_of(a, b, point) == (b.y() > a.y() ? 1 : -1)) is_inside = !is_inside;
  }
  return is_inside;
}

}  // namespace

description::TriangleMesh extruded(const Points& polygon, const std::vector<Points>& holes, double height) {
  std::size_t points = polygon.size();
  for (const Points& hole : holes) points += hole.size();
  if (points > most_polygon_points)
    throw std::invalid_argument("the polygon has " + std::to_string(points) + " points; expected at most " +
                                std::to_string(most_polygon_points));
  Points corners;
  std::vector<Ring> rings;
  const auto add_ring = [&](const Points& outline, bool is_hole) {
    Points own = corners_of(outline);
    expect_simple(own);
    orient(own);
    if (is_hole) std::ranges::reverse(own);
    Ring& ring = rings.emplace_back();
    for (std::size_t i = 0; i < own.size(); ++i) ring.push_back(static_cast<std::uint32_t>(corners.size() + i));
    corners.insert(corners.end(), own.begin(), own.end());
  };
  add_ring(polygon, false);
  for (const Points& hole : holes) add_ring(hole, true);

  description::TriangleMesh mesh;
  const auto count = static_cast<std::uint32_t>(corners.size());
  for (const double z : {0.0, height})
    for (const Vector2d& corner : corners) mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  for (const auto& [a, b, c] : triangles_of(corners, with_cuts(corners, rings))) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({count + a, count + b, count + c});
  }
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t a = ring[i], next = ring[(i + 1) % ring.size()];
      mesh.triangles.push_back({a, next, count + next});
      mesh.triangles.push_back({a, count + next, count + a});
    }
  return mesh;
}

PolygonPlace place_of_polygon(const std::vector<Vector2d>& polygon, const std::vector<Vector2d>& other) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = 0; j < other.size(); ++j)
      if (meet(polygon[i], polygon[(i + 1) % polygon.size()], other[j], other[(j + 1) % other.size()]))
        return PolygonPlace::crossing;
  if (contains(other, polygon.front())) return PolygonPlace::inside;
  return contains(polygon, other.front()) ? PolygonPlace::around : PolygonPlace::apart;
}

}  // namespace cohort::geometry
