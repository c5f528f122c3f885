// SPDX-License-Identifier: Apache-2.0
#include "server/physics/contact/box_contact.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Faces give more points than edges. So an edge axis is preferred only if it separates better than the best face axis
// by this share of the least half width of the two boxes.
constexpr double handicap_share = 0.03;
// The axis of the last step stays until another one is better: a face by this multiple of the same, an edge by the
// same. Otherwise boxes of a heap would change from one to another and back with their last movements, and never rest.
constexpr double last_face_share = 2.0;
constexpr double same_axis = 0.9999;     // cosine
constexpr double least_handicap = 1e-4;  // [m]
constexpr double most_handicap = 1e-3;   // [m]

struct Placed {
  Vector3d half;
  Vector3d centre;
  Matrix3d R;

  double reach(const Vector3d& direction) const { return (R.transpose() * direction).cwiseAbs().dot(half); }
  // Returns the corner that is furthest along a direction.
  Vector3d corner(const Vector3d& direction) const {
    Vector3d corner_W = centre;
    for (int i = 0; i < 3; ++i) corner_W += (R.col(i).dot(direction) < 0.0 ? -half[i] : half[i]) * R.col(i);
    return corner_W;
  }
};

// The clipped face, in the frame of the reference face: x and y lie in that face, z points out of it.
struct Polygon {
  std::array<Vector3d, 8> corners;
  std::size_t count = 0;
  void add(const Vector3d& corner) {
    if (count < corners.size()) corners[count++] = corner;
  }
};

// Keeps the part where sign * coordinate <= limit.
Polygon clip(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vector3d& here = polygon.corners[i];
    const Vector3d& next = polygon.corners[(i + 1) % polygon.count];
    const double beyond_here = sign * here[axis] - limit;
    const double beyond_next = sign * next[axis] - limit;
    if (beyond_here <= 0.0) kept.add(here);
    if ((beyond_here < 0.0 && beyond_next > 0.0) || (beyond_here > 0.0 && beyond_next < 0.0))
      kept.add(here + beyond_here / (beyond_here - beyond_next) * (next - here));
  }
  return kept;
}

// Reduces a polygon to the four corners furthest along the diagonals, always in the same order. These four support the
// face as all of them would.
Polygon thin_out(const Polygon& polygon) {
  Polygon kept;
  std::array<bool, 8> taken{};
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    std::size_t best = 0;
    double furthest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const double along = x * polygon.corners[i].x() + y * polygon.corners[i].y();
      if (along <= furthest) continue;
      furthest = along;
      best = i;
    }
    if (polygon.count == 0 || taken[best]) continue;
    taken[best] = true;
    kept.add(polygon.corners[best]);
  }
  return kept;
}

// `normal`: outward normal of the reference box's face `axis`. `sign`: turns that normal towards a.
void find_face_contact(const Placed& reference, int axis, const Vector3d& normal, const Placed& incident, double sign,
                       double margin, ContactPoints& found) {
  // Find the incident face: the face of the other box that is most nearly opposite to the reference face.
  int facing = 0;
  (incident.R.transpose() * normal).cwiseAbs().maxCoeff(&facing);
  const double away = incident.R.col(facing).dot(normal) > 0.0 ? -1.0 : 1.0;
  const int u = (facing + 1) % 3;
  const int v = (facing + 2) % 3;
  const int x = (axis + 1) % 3;
  const int y = (axis + 2) % 3;
  const Vector3d face_centre = reference.centre + reference.half[axis] * normal;
  Polygon polygon;
  for (const auto& [du, dv] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    const Vector3d corner_W = incident.centre + away * incident.half[facing] * incident.R.col(facing) +
                              du * incident.half[u] * incident.R.col(u) + dv * incident.half[v] * incident.R.col(v);
    const Vector3d offset = corner_W - face_centre;
    polygon.add({reference.R.col(x).dot(offset), reference.R.col(y).dot(offset), normal.dot(offset)});
  }
  polygon = clip(polygon, 0, 1.0, reference.half[x]);
  polygon = clip(polygon, 0, -1.0, reference.half[x]);
  polygon = clip(polygon, 1, 1.0, reference.half[y]);
  polygon = clip(polygon, 1, -1.0, reference.half[y]);
  Polygon near;
  for (std::size_t i = 0; i < polygon.count; ++i)
    if (polygon.corners[i].z() < margin) near.add(polygon.corners[i]);
  near = thin_out(near);
  for (std::size_t i = 0; i < near.count; ++i) {
    const Vector3d& point = near.corners[i];
    const Vector3d position_W =
        face_centre + point.x() * reference.R.col(x) + point.y() * reference.R.col(y) + 0.5 * point.z() * normal;
    found.add(position_W, sign * normal, point.z());
  }
}

void find_edge_contact(const Placed& a, int i, const Placed& b, int j, const Vector3d& normal, double gap,
                       ContactPoints& found) {
  // Find the closest points of the lines through the two edges that face each other.
  const Vector3d on_a = a.corner(-normal);
  const Vector3d on_b = b.corner(normal);
  const Vector3d along_a = a.R.col(i);
  const Vector3d along_b = b.R.col(j);
  const Vector3d offset = on_b - on_a;
  const double cosine = along_a.dot(along_b);
  const double s = (along_a.dot(offset) - cosine * along_b.dot(offset)) / (1.0 - cosine * cosine);
  const Vector3d nearest_a = on_a + s * along_a;
  found.add(nearest_a - 0.5 * gap * normal, normal, gap);
}

}  // namespace

void find_box_contact(const description::Box& box_a, const Pose& X_WA, const description::Box& box_b, const Pose& X_WB,
                      double margin, const Vector3d& last_normal_W, ContactPoints& found) {
  const Placed a{0.5 * box_a.size, X_WA.position, X_WA.orientation.toRotationMatrix()};
  const Placed b{0.5 * box_b.size, X_WB.position, X_WB.orientation.toRotationMatrix()};
  const Vector3d offset = a.centre - b.centre;
  const double handicap =
      std::clamp(handicap_share * std::min(a.half.minCoeff(), b.half.minCoeff()), least_handicap, most_handicap);

  struct Best {
    double rating = -std::numeric_limits<double>::infinity();
    double gap = 0.0;
    Vector3d normal = Vector3d::Zero();  // from b to a
    int axis_a = -1;
    int axis_b = -1;
  } face, edge;
  // Returns false if the boxes are apart along this axis.
  const auto look_along = [&](const Vector3d& axis, int axis_a, int axis_b, double disadvantage,
                              double advantage_of_last, Best& best) {
    const double apart = axis.dot(offset);
    const double gap = std::abs(apart) - a.reach(axis) - b.reach(axis);
    const bool was_last = std::abs(axis.dot(last_normal_W)) > same_axis;
    const double rating = was_last ? gap + advantage_of_last : gap;
    if (rating - disadvantage > best.rating) best = {rating, gap, apart < 0.0 ? Vector3d(-axis) : axis, axis_a, axis_b};
    return gap < margin;
  };
  const double of_last_face = last_face_share * handicap;
  for (int i = 0; i < 3; ++i)
    if (!look_along(b.R.col(i), -1, i, 0.0, of_last_face, face)) return;
  for (int i = 0; i < 3; ++i)
    if (!look_along(a.R.col(i), i, -1, handicap, of_last_face, face)) return;  // equal faces: always b's
  constexpr double parallel = 1e-6;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vector3d axis = a.R.col(i).cross(b.R.col(j));
      const double length = axis.norm();
      if (length > parallel && !look_along(axis / length, i, j, 0.0, handicap, edge)) return;
    }
  }
  const Best& best = edge.rating - handicap > face.rating ? edge : face;
  if (best.axis_a >= 0 && best.axis_b >= 0) {
    find_edge_contact(a, best.axis_a, b, best.axis_b, best.normal, best.gap, found);
  } else if (best.axis_b >= 0) {
    find_face_contact(b, best.axis_b, best.normal, a, 1.0, margin, found);
  } else {
    find_face_contact(a, best.axis_a, -best.normal, b, -1.0, margin, found);
  }
}

}  // namespace cohort::physics
