// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/outlines.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/infinity.hpp"
#include "server/geometry/shapes/footprint.hpp"

namespace cohort::geometry {
namespace {

using description::Box;
using description::Capsule;
using description::Cylinder;
using description::Ellipsoid;
using description::Heightmap;
using description::Mesh;
using description::Plane;
using description::Sphere;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Footprint;

constexpr double most_lean = 0.25;  // sine of the angle

struct Circumscribe {
  const Pose& X_WC;
  const Bounds& bounds;

  Outline circle(double radius) const {
    Outline outline;
    outline.centre_W = X_WC.position.head<2>();
    outline.radius = radius;
    outline.lowest = bounds.lower.z();
    outline.highest = bounds.upper.z();
    return outline;
  }

  Outline rectangle(const Vector2d& centre, const Vector2d& axis, const Vector2d& half) const {
    Outline outline = circle(half.norm());
    outline.centre_W = centre;
    outline.axis_W = axis;
    outline.half = half;
    return outline;
  }

  // Sets the inner cylinder of a solid that holds a cylinder of this radius and half length, tilted by an angle with
  // sine `lean`. Consider a point of the inner cylinder, a from the axis and b above the middle. It is at most a + b *
  // lean from the tilted axis and b + a * lean along it.
  void set_inner(Outline& outline, double radius, double half_length, double lean) const {
    const double a = radius - half_length * lean;
    const double b = half_length - radius * lean;
    if (!(a > 0.0 && b > 0.0)) return;
    outline.inner_radius = a;
    outline.inner_lowest = X_WC.position.z() - b;
    outline.inner_highest = X_WC.position.z() + b;
  }
  void set_inner_ball(Outline& outline, double radius) const {
    const double edge = std::sqrt(0.5) * radius;
    set_inner(outline, edge, edge, 0.0);
  }

  double lean_of_axis() const { return (X_WC.orientation * Vector3d::UnitZ()).head<2>().norm(); }

  Outline of_footprint(const Shape& shape) const {
    const Footprint footprint = *geometry::footprint_of(shape, X_WC);
    if (footprint.half.maxCoeff() <= most_lean * footprint.radius)
      return circle(footprint.radius + footprint.half.norm());
    return rectangle(footprint.centre, footprint.axis, footprint.half.array() + footprint.radius);
  }

  std::optional<Outline> operator()(const Sphere& sphere) const {
    Outline outline = circle(sphere.radius);
    set_inner_ball(outline, sphere.radius);
    return outline;
  }
  std::optional<Outline> operator()(const Cylinder& cylinder) const {
    const double half = 0.5 * cylinder.length;
    const double lean = lean_of_axis();
    Outline outline = lean < most_lean ? circle(cylinder.radius + half * lean) : of_footprint(cylinder);
    set_inner(outline, cylinder.radius, half, lean);
    return outline;
  }
  std::optional<Outline> operator()(const Capsule& capsule) const {
    Outline outline = of_footprint(capsule);
    set_inner_ball(outline, capsule.radius);
    if (0.5 * capsule.length > capsule.radius) set_inner(outline, capsule.radius, 0.5 * capsule.length, lean_of_axis());
    return outline;
  }
  std::optional<Outline> operator()(const Ellipsoid& ellipsoid) const {
    Outline outline = of_footprint(ellipsoid);
    set_inner_ball(outline, ellipsoid.radii.minCoeff());
    return outline;
  }
  std::optional<Outline> operator()(const Box& box) const {
    Outline outline = of_footprint(box);
    const Vector3d up_C = X_WC.orientation.conjugate() * Vector3d::UnitZ();
    int upright = 0;
    up_C.cwiseAbs().maxCoeff(&upright);
    const double lean = Vector2d(up_C[(upright + 1) % 3], up_C[(upright + 2) % 3]).norm();
    const Vector3d half = 0.5 * box.size;
    set_inner(outline, std::min(half[(upright + 1) % 3], half[(upright + 2) % 3]), half[upright], lean);
    return outline;
  }
  std::optional<Outline> of_bounds() const {
    const Vector2d size = (bounds.upper - bounds.lower).head<2>();
    if (!(size.maxCoeff() < infinity)) return std::nullopt;
    return rectangle(0.5 * (bounds.lower + bounds.upper).head<2>(), Vector2d::UnitX(), 0.5 * size);
  }
  std::optional<Outline> operator()(const Mesh&) const { return of_bounds(); }
  std::optional<Outline> operator()(const Heightmap&) const { return of_bounds(); }
  std::optional<Outline> operator()(const Plane&) const { return std::nullopt; }
};

}  // namespace

std::optional<Outline> outline_of(const Solid& solid, const Bounds& bounds) {
  return std::visit(Circumscribe{solid.X_WC, bounds}, solid.shape());
}

Outlines::Outlines(const Scene& scene) : scene_(&scene), item_of_(scene.size(), none) {
  std::vector<double> widths;
  for (std::uint32_t index = 0; index < scene.size(); ++index) {
    if (scene.is_removed(index)) continue;
    const Solid& solid = scene.solid(index);
    item_of_[index] = static_cast<std::uint32_t>(items_.size());
    items_.push_back({outline_of(solid, scene.bounds(index)), index, solid.body});
    if (solid.moves) widths.push_back(2.0 * scene.ball(index).radius);
  }
  if (widths.empty()) return;
  std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
  width_ = widths[widths.size() / 2];
}

// A cell of the grid costs as much as this many items that are out of range.
bool Outlines::is_grid_faster(double range) const {
  constexpr double items_a_cell = 4.0;
  const double edge = 2.0 * range / width_ + 3.0;
  return items_a_cell * edge * edge < static_cast<double>(items_.size());
}

}  // namespace cohort::geometry
