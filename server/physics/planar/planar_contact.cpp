// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/core/plane_vectors.hpp"

namespace cohort::physics {
namespace {

using Eigen::Vector2d;
using geometry::Footprint;

// The direction between two points nearer than this is undefined [m].
constexpr double coincident = 1e-12;

bool is_disc(const Footprint& footprint) { return footprint.half.x() == 0.0 && footprint.half.y() == 0.0; }
Vector2d across(const Footprint& footprint) { return left_of(footprint.axis); }

std::array<Vector2d, 4> corners_of(const Footprint& footprint) {
  const Vector2d x = footprint.half.x() * footprint.axis;
  const Vector2d y = footprint.half.y() * across(footprint);
  return {footprint.centre - x - y, footprint.centre + x - y, footprint.centre + x + y, footprint.centre - x + y};
}

// The offset from a rectangle without its rounding to a point: unit `normal`, and `distance`, negative inside.
struct Offset {
  Vector2d normal;
  double distance;
  bool is_beyond_corner;
};
Offset offset_of(const Vector2d& point, const Footprint& rectangle) {
  const Vector2d from_centre = point - rectangle.centre;
  const Vector2d local(rectangle.axis.dot(from_centre), across(rectangle).dot(from_centre));
  const Vector2d sign(local.x() < 0.0 ? -1.0 : 1.0, local.y() < 0.0 ? -1.0 : 1.0);
  const Vector2d beyond = local.cwiseAbs() - rectangle.half;
  if (beyond.x() > 0.0 && beyond.y() > 0.0) {
    const double distance = beyond.norm();
    const Vector2d normal = beyond.cwiseProduct(sign) / distance;
    return {normal.x() * rectangle.axis + normal.y() * across(rectangle), distance, true};
  }
  if (beyond.x() > beyond.y()) return {sign.x() * rectangle.axis, beyond.x(), false};
  return {sign.y() * across(rectangle), beyond.y(), false};
}

void add_between(const Vector2d& core_a, const Vector2d& normal, double core_distance, double radius_a, double radius_b,
                 PlanarPoints& found) {
  const double gap = core_distance - radius_a - radius_b;
  found.add(core_a - (radius_a + 0.5 * gap) * normal, normal, gap);
}

void find_disc_disc(const Footprint& a, const Footprint& b, double margin, PlanarPoints& found) {
  const Vector2d between = a.centre - b.centre;
  const double reach = a.radius + b.radius + margin;
  const double squared = between.squaredNorm();
  if (squared >= reach * reach) return;
  const double distance = std::sqrt(squared);
  const Vector2d normal = distance > coincident ? Vector2d(between / distance) : Vector2d(Vector2d::UnitX());
  add_between(a.centre, normal, distance, a.radius, b.radius, found);
}

struct Face {
  double separation = -std::numeric_limits<double>::infinity();
  Vector2d normal = Vector2d::UnitX();  // outward
  Vector2d middle = Vector2d::Zero();   // middle of the edge
  double half_length = 0.0;
};

// Returns the face of `of` with the greatest separation from `other`.
Face furthest_face(const Footprint& of, const Footprint& other) {
  Face best;
  const Vector2d between = other.centre - of.centre;
  const auto try_face = [&](const Vector2d& axis, double half, double half_length) {
    const Vector2d normal = axis.dot(between) < 0.0 ? Vector2d(-axis) : axis;
    const double other_half =
        std::abs(normal.dot(other.axis)) * other.half.x() + std::abs(normal.dot(across(other))) * other.half.y();
    const double separation = normal.dot(between) - half - other_half;
    if (separation > best.separation) best = {separation, normal, of.centre + half * normal, half_length};
  };
  try_face(of.axis, of.half.x(), of.half.y());
  try_face(across(of), of.half.y(), of.half.x());
  return best;
}

// Returns the two corners of the rectangle's edge that faces `direction`.
std::array<Vector2d, 2> facing_edge(const Footprint& rectangle, const Vector2d& direction) {
  const double along_x = rectangle.axis.dot(direction);
  const double along_y = across(rectangle).dot(direction);
  // A segment has edges along its length only.
  const bool is_x = rectangle.half.y() > 0.0 && (rectangle.half.x() == 0.0 || std::abs(along_x) > std::abs(along_y));
  const Vector2d normal = is_x ? Vector2d(along_x < 0.0 ? -rectangle.axis : rectangle.axis)
                               : Vector2d(along_y < 0.0 ? -across(rectangle) : across(rectangle));
  const Vector2d middle = rectangle.centre + (is_x ? rectangle.half.x() : rectangle.half.y()) * normal;
  const Vector2d half = (is_x ? rectangle.half.y() : rectangle.half.x()) * left_of(normal);
  return {middle - half, middle + half};
}

// Clips the part of an edge beyond `limit` along `direction`. Returns false if nothing is left.
bool clip(std::array<Vector2d, 2>& edge, const Vector2d& direction, double limit) {
  const double first = direction.dot(edge[0]) - limit;
  const double second = direction.dot(edge[1]) - limit;
  if (first > 0.0 && second > 0.0) return false;
  if (first > 0.0) edge[0] += first / (first - second) * (edge[1] - edge[0]);
  if (second > 0.0) edge[1] += second / (second - first) * (edge[0] - edge[1]);
  return true;
}

// Finds, for separated rectangles, the two corners that face each other, if they are nearer than any edge.
bool find_corner_corner(const Footprint& a, const Footprint& b, double margin, PlanarPoints& found) {
  double nearest = std::numeric_limits<double>::infinity();
  bool is_corner = false;
  Vector2d on_a;
  Vector2d normal;
  const auto try_corners = [&](const Footprint& one, const Footprint& other, double sign) {
    for (const Vector2d& corner : corners_of(one)) {
      const Offset offset = offset_of(corner, other);
      if (offset.distance >= nearest) continue;
      nearest = offset.distance;
      is_corner = offset.is_beyond_corner;
      normal = sign * offset.normal;
      on_a = sign > 0.0 ? corner : Vector2d(corner - offset.distance * offset.normal);
    }
  };
  try_corners(a, b, 1.0);
  try_corners(b, a, -1.0);
  if (!is_corner) return false;
  if (nearest < a.radius + b.radius + margin) add_between(on_a, normal, nearest, a.radius, b.radius, found);
  return true;
}

void find_edges(const Footprint& a, const Footprint& b, double margin, PlanarPoints& found) {
  const double reach = a.radius + b.radius + margin;
  const Face face_a = furthest_face(a, b);
  const Face face_b = furthest_face(b, a);
  const double separation = std::max(face_a.separation, face_b.separation);
  if (separation >= reach) return;
  if (separation > 0.0 && a.radius + b.radius > 0.0 && find_corner_corner(a, b, margin, found)) return;

  // Prefer a slightly, so that rounding does not swap the two from step to step.
  constexpr double favour = 1e-6;
  const bool is_on_a = face_a.separation >= face_b.separation - favour;
  const Face& face = is_on_a ? face_a : face_b;
  std::array<Vector2d, 2> edge = facing_edge(is_on_a ? b : a, -face.normal);
  const Vector2d along = left_of(face.normal);
  const double middle = along.dot(face.middle);
  if (!clip(edge, along, middle + face.half_length) || !clip(edge, -along, -middle + face.half_length)) return;
  const Vector2d normal = is_on_a ? Vector2d(-face.normal) : face.normal;
  for (const Vector2d& point : edge) {
    const double distance = face.normal.dot(point - face.middle);
    if (distance >= reach) continue;
    const Vector2d on_a = is_on_a ? Vector2d(point - distance * face.normal) : point;
    add_between(on_a, normal, distance, a.radius, b.radius, found);
  }
}

}  // namespace

void find_planar_contact(const Footprint& a, const Footprint& b, double margin, PlanarPoints& found) {
  if (is_disc(a) && is_disc(b)) return find_disc_disc(a, b, margin, found);
  if (is_disc(a)) {
    const Offset offset = offset_of(a.centre, b);
    if (offset.distance < a.radius + b.radius + margin)
      add_between(a.centre, offset.normal, offset.distance, a.radius, b.radius, found);
  } else if (is_disc(b)) {
    const Offset offset = offset_of(b.centre, a);
    if (offset.distance < a.radius + b.radius + margin)
      add_between(b.centre - offset.distance * offset.normal, -offset.normal, offset.distance, a.radius, b.radius,
                  found);
  } else {
    find_edges(a, b, margin, found);
  }
}

void find_planar_contact(const Footprint& a, const HalfPlane& b, double margin, PlanarPoints& found) {
  const auto touch = [&](const Vector2d& core) {
    const double distance = b.normal_W.dot(core) - b.offset;
    if (distance < a.radius + margin) add_between(core, b.normal_W, distance, a.radius, 0.0, found);
  };
  if (is_disc(a)) return touch(a.centre);
  for (const Vector2d& corner : facing_edge(a, -b.normal_W)) touch(corner);
}

}  // namespace cohort::physics
