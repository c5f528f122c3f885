// SPDX-License-Identifier: Apache-2.0
#include "server/physics/fluid/floating_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "server/geometry/shapes/convex_hull.hpp"

namespace cohort::physics {
namespace {

using description::TriangleMesh;
using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

using Points = std::vector<Vector3d>;

// Adds a ring of points around the z axis.
void add_ring(double radius, double z, Points& points) {
  constexpr int sides = 64;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * pi * i / sides;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

Points points_of(const description::Box& box) {
  Points points;
  for (int corner = 0; corner < 8; ++corner)
    points.push_back(0.5 *
                     box.size.cwiseProduct(Vector3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
  return points;
}
Points points_of(const description::Cylinder& cylinder) {
  Points points;
  for (const double end : {-0.5, 0.5}) add_ring(cylinder.radius, end * cylinder.length, points);
  return points;
}
Points points_of(const description::Capsule& capsule) {
  constexpr int rings = 12;  // on each end cap
  Points points;
  for (const double end : {-1.0, 1.0}) {
    for (int i = 0; i < rings; ++i) {
      const double latitude = 0.5 * pi * i / rings;
      add_ring(capsule.radius * std::cos(latitude), end * (0.5 * capsule.length + capsule.radius * std::sin(latitude)),
               points);
    }
    points.emplace_back(0.0, 0.0, end * (0.5 * capsule.length + capsule.radius));
  }
  return points;
}

// Sums over the submerged part about a point O of the water surface. The volume is split into tetrahedra from O to the
// triangles below the surface; those to the section itself are flat. The section is split into triangles from O to its
// edges.
struct Sums {
  double volume = 0.0;
  Vector3d first = Vector3d::Zero();  // ∫ r dV
  double area = 0.0;
  Vector3d area_first = Vector3d::Zero();  // ∫ r dA
  Eigen::Matrix2d area_second = Eigen::Matrix2d::Zero();

  void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double part = a.dot(b.cross(c)) / 6.0;
    volume += part;
    first += 0.25 * part * (a + b + c);
  }
  void add_edge(const Vector3d& p, const Vector3d& q) {
    const double part = 0.5 * (p.x() * q.y() - p.y() * q.x());
    area += part;
    area_first += part / 3.0 * (p + q);
    const Eigen::Vector2d a = p.head<2>(), b = q.head<2>();
    area_second += part / 12.0 * ((a + b) * (a + b).transpose() + a * a.transpose() + b * b.transpose());
  }
  // Adds the part of a triangle below z = 0. Corners are counter-clockwise seen from outside.
  void add_cut(const std::array<Vector3d, 3>& corners) {
    std::array<Vector3d, 4> kept;
    std::size_t count = 0;
    Vector3d entry = Vector3d::Zero(), exit = Vector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& from = corners[i];
      const Vector3d& to = corners[(i + 1) % 3];
      if (from.z() < 0.0) kept[count++] = from;
      if ((from.z() < 0.0) == (to.z() < 0.0)) continue;
      Vector3d& crossing = from.z() < 0.0 ? exit : entry;
      crossing = from + from.z() / (from.z() - to.z()) * (to - from);
      crossing.z() = 0.0;
      kept[count++] = crossing;
    }
    for (std::size_t i = 2; i < count; ++i) add_triangle(kept[0], kept[i - 1], kept[i]);
    if (count > 0) add_edge(entry, exit);
  }
};

}  // namespace

void SubmergedPart::add(const SubmergedPart& other) {
  if (other.volume > 0.0) {
    volume += other.volume;
    centre_W += other.volume / volume * (other.centre_W - centre_W);
  }
  if (other.area > 0.0) {
    const Vector3d apart = other.area_centre_W - area_centre_W;
    const double share = other.area / (area + other.area);
    second_moment_W += other.second_moment_W + area * share * apart.head<2>() * apart.head<2>().transpose();
    area += other.area;
    area_centre_W += share * apart;
  }
}

FloatingShape::FloatingShape(const geometry::Shape& shape) {
  if (const auto* sphere = std::get_if<description::Sphere>(&shape)) radii_.setConstant(sphere->radius);
  if (const auto* ellipsoid = std::get_if<description::Ellipsoid>(&shape)) radii_ = ellipsoid->radii;
  if (const auto* box = std::get_if<description::Box>(&shape)) take(geometry::convex_hull(points_of(*box)));
  if (const auto* mesh = std::get_if<description::Mesh>(&shape); mesh != nullptr && mesh->convex)
    take(geometry::convex_hull(mesh->triangles->vertices));
  if (const auto* cylinder = std::get_if<description::Cylinder>(&shape))
    take_round(geometry::convex_hull(points_of(*cylinder)),
               pi * cylinder->radius * cylinder->radius * cylinder->length);
  if (const auto* capsule = std::get_if<description::Capsule>(&shape))
    take_round(geometry::convex_hull(points_of(*capsule)),
               pi * capsule->radius * capsule->radius * (capsule->length + 4.0 / 3.0 * capsule->radius));
  if (radii_.x() > 0.0) {
    whole_volume_ = 4.0 / 3.0 * pi * radii_.prod();
    reach_ = radii_.maxCoeff();
  }
}

void FloatingShape::take(const TriangleMesh& polyhedron) {
  polyhedron_ = polyhedron;
  Sums sums;
  for (const auto& [a, b, c] : polyhedron_.triangles)
    sums.add_triangle(polyhedron_.vertices[a], polyhedron_.vertices[b], polyhedron_.vertices[c]);
  whole_volume_ = sums.volume;
  whole_centre_ = sums.first / sums.volume;
  reach_ = 0.0;
  for (const Vector3d& vertex : polyhedron_.vertices) reach_ = std::max(reach_, vertex.norm());
}

// Takes the polyhedron, widened until it has this volume.
void FloatingShape::take_round(const TriangleMesh& polyhedron, double volume) {
  take(polyhedron);
  const double wider = std::sqrt(volume / whole_volume_);
  TriangleMesh widened = polyhedron;
  for (Vector3d& vertex : widened.vertices) vertex.head<2>() *= wider;
  take(widened);
}

SubmergedPart FloatingShape::below(double level, const Pose& X_WC) const {
  const double depth = level - X_WC.position.z();
  if (depth <= -reach_) return {};
  if (depth >= reach_) {
    SubmergedPart whole;
    whole.volume = whole_volume_;
    whole.centre_W = X_WC * whole_centre_;
    return whole;
  }
  return radii_.x() > 0.0 ? ellipsoid_below(level, X_WC) : polyhedron_below(level, X_WC);
}

// The ellipsoid is E times the unit ball. In the frame of that ball, the water surface is a plane at height t along a
// unit vector.
SubmergedPart FloatingShape::ellipsoid_below(double level, const Pose& X_WC) const {
  const Eigen::Matrix3d E = X_WC.orientation.toRotationMatrix() * radii_.asDiagonal();
  const Vector3d upwards = E.row(2);
  const double half_height = upwards.norm();
  const Vector3d m = upwards / half_height;
  const double t = std::clamp((level - X_WC.position.z()) / half_height, -1.0, 1.0);
  SubmergedPart part;
  const double cap = pi / 3.0 * (1.0 + t) * (1.0 + t) * (2.0 - t);
  if (cap <= 0.0) return part;
  const double stretch = radii_.prod();
  const double disc = 1.0 - t * t;  // squared radius of the section
  part.volume = stretch * cap;
  part.centre_W = X_WC.position + E * (-0.25 * pi * disc * disc / cap * m);
  part.area = stretch / half_height * pi * disc;
  part.area_centre_W = X_WC.position + E * (t * m);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - m * m.transpose();
  part.second_moment_W =
      (stretch / half_height * 0.25 * pi * disc * disc * (E * across * E.transpose())).topLeftCorner<2, 2>();
  return part;
}

SubmergedPart FloatingShape::polyhedron_below(double level, const Pose& X_WC) const {
  const Eigen::Matrix3d R = X_WC.orientation.toRotationMatrix();
  const Vector3d origin_W(X_WC.position.x(), X_WC.position.y(), level);
  const Vector3d to_shape(0.0, 0.0, X_WC.position.z() - level);
  Sums sums;
  const auto corner = [&](std::uint32_t index) -> Vector3d { return R * polyhedron_.vertices[index] + to_shape; };
  for (const auto& [a, b, c] : polyhedron_.triangles) sums.add_cut({corner(a), corner(b), corner(c)});
  SubmergedPart part;
  if (!(sums.volume > 0.0)) return part;
  part.volume = sums.volume;
  part.centre_W = origin_W + sums.first / sums.volume;
  if (!(sums.area > 0.0)) return part;
  const Vector3d centre = sums.area_first / sums.area;
  part.area = sums.area;
  part.area_centre_W = origin_W + centre;
  part.second_moment_W = sums.area_second - sums.area * centre.head<2>() * centre.head<2>().transpose();
  return part;
}

}  // namespace cohort::physics
