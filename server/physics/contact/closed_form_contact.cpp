// SPDX-License-Identifier: Apache-2.0
#include "server/physics/contact/closed_form_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "server/physics/contact/box_contact.hpp"
#include "server/physics/contact/prism_contact.hpp"

namespace cohort::physics {
namespace {

using description::Box;
using description::Capsule;
using description::Cylinder;
using description::Ellipsoid;
using description::Mesh;
using description::Plane;
using description::Sphere;
using Eigen::Matrix3d;
using Eigen::Vector3d;

struct HalfSpace {
  Vector3d normal_W;
  double offset;  // position of the surface along the normal

  HalfSpace(const Plane& plane, const Pose& X_W)
      : normal_W(X_W.orientation * plane.normal), offset(normal_W.dot(X_W.position)) {}
  double height(const Vector3d& point_W) const { return normal_W.dot(point_W) - offset; }
};

void touch_plane(const Vector3d& point_W, const HalfSpace& plane, double margin, ContactPoints& found) {
  const double gap = plane.height(point_W);
  if (gap < margin) found.add(point_W - 0.5 * gap * plane.normal_W, plane.normal_W, gap);
}

void on_plane(const Sphere& sphere, const Pose& X_W, const HalfSpace& plane, double margin, ContactPoints& found) {
  touch_plane(X_W.position - sphere.radius * plane.normal_W, plane, margin, found);
}

void on_plane(const Box& box, const Pose& X_W, const HalfSpace& plane, double margin, ContactPoints& found) {
  const Matrix3d R = X_W.orientation.toRotationMatrix();
  struct Corner {
    double height;
    std::uint32_t index;
    bool operator<(const Corner& other) const {
      return height < other.height || (height == other.height && index < other.index);
    }
  };
  std::array<Corner, 8> corners{};
  std::array<Vector3d, 8> positions_W;
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const Vector3d signs((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
    positions_W[i] = X_W.position + R * signs.cwiseProduct(box.size);
    corners[i] = {plane.height(positions_W[i]), i};
  }
  constexpr std::size_t corners_of_a_face = 4;
  std::partial_sort(corners.begin(), corners.begin() + corners_of_a_face, corners.end());
  // Add them in the order of the corners, so that the solver sees the same rows in each step.
  std::array<std::uint32_t, corners_of_a_face> lowest{};
  for (std::size_t i = 0; i < lowest.size(); ++i) lowest[i] = corners[i].index;
  std::sort(lowest.begin(), lowest.end());
  for (const std::uint32_t corner : lowest) touch_plane(positions_W[corner], plane, margin, found);
}

// Returns two directions perpendicular to each other and to the axis. They give four points on the rim that form a
// square; on a slope, one of its corners is the lowest point, over which the cylinder tips.
std::array<Vector3d, 2> directions_on_rim(const Matrix3d& R, const Vector3d& normal_W) {
  const Vector3d downhill = normal_W.z() * normal_W - Vector3d::UnitZ();
  constexpr double level = 1e-3;
  if (downhill.norm() < level) return {R.col(0), R.col(1)};
  const Vector3d axis = R.col(2);
  const Vector3d first = (downhill - downhill.dot(axis) * axis).normalized();
  return {first, axis.cross(first)};
}

void on_plane(const Cylinder& cylinder, const Pose& X_W, const HalfSpace& plane, double margin, ContactPoints& found) {
  const Matrix3d R = X_W.orientation.toRotationMatrix();
  const Vector3d axis = R.col(2);
  const double upright = axis.dot(plane.normal_W);
  const Vector3d to_end = 0.5 * cylinder.length * axis;
  constexpr double stands = 0.95;
  if (std::abs(upright) > stands) {
    const Vector3d end = X_W.position - (upright > 0.0 ? 1.0 : -1.0) * to_end;
    const std::array<Vector3d, 2> across = directions_on_rim(R, plane.normal_W);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vector3d rim = cylinder.radius * ((i & 1) != 0 ? -1.0 : 1.0) * across[i / 2];
      touch_plane(end + rim, plane, margin, found);
    }
    return;
  }
  // The cylinder lies or leans: the ends and the middle of its lowest line are the points. A wheel that turns about its
  // middle slips at both ends. Without the middle, it might as well turn about a point between the middle and an end.
  const Vector3d down = (upright * axis - plane.normal_W).normalized();
  for (const double share : {-1.0, 0.0, 1.0})
    touch_plane(X_W.position + cylinder.radius * down + share * to_end, plane, margin, found);
}

void on_plane(const Capsule& capsule, const Pose& X_W, const HalfSpace& plane, double margin, ContactPoints& found) {
  const Vector3d to_end = X_W.orientation * Vector3d(0.0, 0.0, 0.5 * capsule.length);
  const Vector3d down = -capsule.radius * plane.normal_W;
  touch_plane(X_W.position - to_end + down, plane, margin, found);
  touch_plane(X_W.position + to_end + down, plane, margin, found);
}

void on_plane(const Ellipsoid& ellipsoid, const Pose& X_W, const HalfSpace& plane, double margin,
              ContactPoints& found) {
  const Vector3d scaled = ellipsoid.radii.cwiseProduct(X_W.orientation.conjugate() * plane.normal_W);
  const Vector3d lowest = -ellipsoid.radii.cwiseProduct(scaled) / scaled.norm();
  touch_plane(X_W * lowest, plane, margin, found);
}

// A vertex near a plane.
struct LowVertex {
  Vector3d point_W;
  double height;
  double away = std::numeric_limits<double>::infinity();  // squared distance to the nearest vertex that was taken
  bool is_taken = false;
};

// Returns the vertex that is furthest from those taken, or nullptr if all were taken. Those that touch come first.
LowVertex* next_to_take(std::vector<LowVertex>& near) {
  for (const double highest : {0.0, std::numeric_limits<double>::infinity()}) {
    LowVertex* furthest = nullptr;
    for (LowVertex& vertex : near)
      if (vertex.height <= highest && vertex.away > 0.0 && (furthest == nullptr || vertex.away > furthest->away))
        furthest = &vertex;
    if (furthest != nullptr) return furthest;
  }
  return nullptr;
}

// Takes the vertices near the plane. If there are too many, it takes the lowest one and then those that are furthest
// from each other.
void on_plane(const Mesh& mesh, const Pose& X_W, const HalfSpace& plane, double margin, ContactPoints& found) {
  if (!mesh.convex) return;  // it is static, and so is the plane
  std::vector<LowVertex> near;
  for (const Vector3d& vertex : mesh.triangles->vertices) {
    const Vector3d point_W = X_W * vertex;
    const double height = plane.height(point_W);
    if (height < margin) near.push_back({point_W, height});
  }
  const bool is_all = std::ssize(near) <= ContactPoints::most;
  LowVertex* next = is_all ? nullptr : &*std::ranges::min_element(near, {}, &LowVertex::height);
  for (int i = 0; next != nullptr && i < ContactPoints::most; ++i) {
    next->is_taken = true;
    for (LowVertex& vertex : near) vertex.away = std::min(vertex.away, (vertex.point_W - next->point_W).squaredNorm());
    next = next_to_take(near);
  }
  for (const LowVertex& vertex : near)
    if (is_all || vertex.is_taken) touch_plane(vertex.point_W, plane, margin, found);
}

// The point of a box's surface nearest to `point`, both in the box's frame. For a point inside, it is on the nearest
// face.
struct Nearest {
  Vector3d point;
  Vector3d normal;  // towards the other point
  double distance;  // negative inside
};

std::optional<Nearest> nearest_on(const Box& box, const Vector3d& point) {
  const Vector3d half = 0.5 * box.size;
  const Vector3d clamped = point.cwiseMax(-half).cwiseMin(half);
  const Vector3d offset = point - clamped;
  const double distance = offset.norm();
  if (distance > 0.0) return Nearest{clamped, offset / distance, distance};
  const Vector3d depth = half - point.cwiseAbs();
  int axis = 0;
  depth.minCoeff(&axis);
  Nearest nearest{point, Vector3d::Zero(), -depth[axis]};
  nearest.normal[axis] = point[axis] < 0.0 ? -1.0 : 1.0;
  nearest.point[axis] = nearest.normal[axis] * half[axis];
  return nearest;
}

std::optional<Nearest> nearest_on(const Cylinder& cylinder, const Vector3d& point) {
  const double half = 0.5 * cylinder.length;
  const double radial = point.head<2>().norm();
  const Vector3d outwards =
      radial > 0.0 ? Vector3d(point.x() / radial, point.y() / radial, 0.0) : Vector3d(Vector3d::UnitX());
  const double beyond_side = radial - cylinder.radius;
  const double beyond_end = std::abs(point.z()) - half;
  const Vector3d up = (point.z() < 0.0 ? -1.0 : 1.0) * Vector3d::UnitZ();
  if (beyond_side <= 0.0 && beyond_end <= 0.0) {  // inside
    if (beyond_side > beyond_end) return Nearest{point - beyond_side * outwards, outwards, beyond_side};
    return Nearest{point - beyond_end * up, up, beyond_end};
  }
  const Vector3d offset = std::max(0.0, beyond_side) * outwards + std::max(0.0, beyond_end) * up;
  const double distance = offset.norm();
  return Nearest{point - offset, offset / distance, distance};
}

std::optional<Nearest> nearest_on(const Capsule& capsule, const Vector3d& point) {
  const Vector3d on_axis(0.0, 0.0, std::clamp(point.z(), -0.5 * capsule.length, 0.5 * capsule.length));
  const Vector3d offset = point - on_axis;
  const double distance = offset.norm();
  const Vector3d normal = distance > 0.0 ? Vector3d(offset / distance) : Vector3d(Vector3d::UnitX());
  return Nearest{on_axis + capsule.radius * normal, normal, distance - capsule.radius};
}

std::optional<Nearest> nearest_on(const Sphere& sphere, const Vector3d& point) {
  const double distance = point.norm();
  const Vector3d normal = distance > 0.0 ? Vector3d(point / distance) : Vector3d(Vector3d::UnitZ());
  return Nearest{sphere.radius * normal, normal, distance - sphere.radius};
}

template <class Other>
std::optional<Nearest> nearest_on(const Other&, const Vector3d&) {
  return std::nullopt;
}

// Finds the contact of sphere a with any b that has a nearest point. `flipped`: the sphere is b.
bool ball_on(const Sphere& sphere, const Pose& X_WA, const geometry::Shape& b, const Pose& X_WB, double margin,
             bool flipped, ContactPoints& found) {
  const Pose X_BW = X_WB.inverse();
  const Vector3d centre = X_BW * X_WA.position;
  const std::optional<Nearest> nearest = std::visit([&](const auto& shape) { return nearest_on(shape, centre); }, b);
  if (!nearest) return false;
  const double gap = nearest->distance - sphere.radius;
  if (gap >= margin) return true;
  const Vector3d normal_W = X_WB.orientation * nearest->normal;
  const Vector3d position_W = X_WB * nearest->point + 0.5 * gap * normal_W;
  found.add(position_W, flipped ? Vector3d(-normal_W) : normal_W, gap);
  return true;
}

// Finds the contact of a shape with a plane. `flipped`: the plane is a.
bool anything_on_plane(const geometry::Shape& shape, const Pose& X_W, const HalfSpace& plane, double margin,
                       bool flipped, ContactPoints& found) {
  const bool known = std::visit(
      [&](const auto& s) {
        if constexpr (requires { on_plane(s, X_W, plane, margin, found); }) {
          on_plane(s, X_W, plane, margin, found);
          return true;
        } else {
          return false;
        }
      },
      shape);
  if (flipped)
    for (ContactPoint& point : found) point.normal_W = -point.normal_W;
  return known;
}

// Returns the face of a box that the whole cylinder is above: for this contact the face can be treated as an infinite
// plane.
std::optional<HalfSpace> face_under(const Cylinder& cylinder, const Pose& X_WC, const Box& box, const Pose& X_WB) {
  const Pose X_BC = X_WB.inverse() * X_WC;
  const geometry::Bounds around = geometry::bounds_of(cylinder, X_BC);
  const Vector3d half = 0.5 * box.size;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(X_BC.position[axis]) <= half[axis]) continue;
    const auto is_within = [&](int other) {
      return other == axis || (around.lower[other] >= -half[other] && around.upper[other] <= half[other]);
    };
    if (!is_within(0) || !is_within(1) || !is_within(2)) continue;
    Vector3d normal = Vector3d::Zero();
    normal[axis] = X_BC.position[axis] > 0.0 ? 1.0 : -1.0;
    return HalfSpace({normal}, {X_WB * Vector3d(half[axis] * normal), X_WB.orientation});
  }
  return std::nullopt;
}

bool cylinder_on_box(const Cylinder& cylinder, const Pose& X_WC, const Box& box, const Pose& X_WB, double margin,
                     ContactPoints& found) {
  if (find_side_contact(cylinder, X_WC, box, X_WB, margin, found)) return true;
  const std::optional<HalfSpace> face = face_under(cylinder, X_WC, box, X_WB);
  if (!face) return false;
  on_plane(cylinder, X_WC, *face, margin, found);
  return true;
}

}  // namespace

bool find_closed_form_contact(const geometry::Shape& a, const Pose& X_WA, const geometry::Shape& b, const Pose& X_WB,
                              double margin, const Vector3d& last_normal_W, ContactPoints& found) {
  if (const auto* plane = std::get_if<Plane>(&b))
    return anything_on_plane(a, X_WA, HalfSpace(*plane, X_WB), margin, false, found);
  if (const auto* plane = std::get_if<Plane>(&a))
    return anything_on_plane(b, X_WB, HalfSpace(*plane, X_WA), margin, true, found);
  if (const auto* sphere = std::get_if<Sphere>(&a)) return ball_on(*sphere, X_WA, b, X_WB, margin, false, found);
  // NOLINTNEXTLINE(readability-suspicious-call-argument): the two change places, and `flipped` says so.
  if (const auto* sphere = std::get_if<Sphere>(&b)) return ball_on(*sphere, X_WB, a, X_WA, margin, true, found);

  const auto* cylinder_a = std::get_if<Cylinder>(&a);
  const auto* cylinder_b = std::get_if<Cylinder>(&b);
  if (cylinder_a != nullptr && cylinder_b != nullptr)
    return find_side_contact(*cylinder_a, X_WA, *cylinder_b, X_WB, margin, found);
  const auto* box_a = std::get_if<Box>(&a);
  const auto* box_b = std::get_if<Box>(&b);
  if (cylinder_a != nullptr && box_b != nullptr) return cylinder_on_box(*cylinder_a, X_WA, *box_b, X_WB, margin, found);
  if (box_a != nullptr && cylinder_b != nullptr) {
    // NOLINTNEXTLINE(readability-suspicious-call-argument): the two change places, and the normals are turned round.
    const bool known = cylinder_on_box(*cylinder_b, X_WB, *box_a, X_WA, margin, found);
    for (ContactPoint& point : found) point.normal_W = -point.normal_W;
    return known;
  }
  if (box_a == nullptr || box_b == nullptr) return false;
  find_box_contact(*box_a, X_WA, *box_b, X_WB, margin, last_normal_W, found);
  return true;
}

}  // namespace cohort::physics
