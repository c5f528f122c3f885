// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/outline.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace cohort::tool {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int corners_of_a_circle = 48;

Vector2d on_circle(int corner) {
  const double angle = 2.0 * std::numbers::pi * corner / corners_of_a_circle;
  return {std::cos(angle), std::sin(angle)};
}

struct Seen {
  const Pose& X_VC;

  Vector2d shown(const Vector3d& point_C) const { return (X_VC * point_C).head<2>(); }
  Outline circle(double radius) const { return {{}, X_VC.position.head<2>(), radius}; }

  Outline operator()(const description::Box& box) const {
    Outline outline;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) outline.corners_V.push_back(shown(Vector3d(x, y, z).cwiseProduct(box.size)));
    return outline;
  }

  Outline operator()(const description::Sphere& sphere) const { return circle(sphere.radius); }

  Outline operator()(const description::Cylinder& cylinder) const {
    const Vector3d axis_V = X_VC.orientation * Vector3d::UnitZ();
    if (axis_V.head<2>().norm() < 1e-3) return circle(cylinder.radius);
    Outline outline;
    for (int i = 0; i < corners_of_a_circle; ++i) {
      const Vector2d at = cylinder.radius * on_circle(i);
      for (const double z : {-0.5, 0.5}) outline.corners_V.push_back(shown({at.x(), at.y(), z * cylinder.length}));
    }
    return outline;
  }

  Outline operator()(const description::Capsule& capsule) const {
    Outline outline;
    for (int i = 0; i < corners_of_a_circle; ++i)
      for (const double z : {-0.5, 0.5})
        outline.corners_V.push_back(shown({0.0, 0.0, z * capsule.length}) + capsule.radius * on_circle(i));
    return outline;
  }

  Outline operator()(const description::Ellipsoid& ellipsoid) const {
    const Eigen::Matrix3d axes = X_VC.orientation.toRotationMatrix() * ellipsoid.radii.asDiagonal();
    Outline outline;
    for (int i = 0; i < corners_of_a_circle; ++i) {
      // The farthest point of the ellipsoid in this direction.
      const Vector3d furthest = axes.topRows<2>().transpose() * on_circle(i);
      outline.corners_V.push_back(X_VC.position.head<2>() + axes.topRows<2>() * furthest.normalized());
    }
    return outline;
  }

  Outline operator()(const description::Mesh& mesh) const {
    Outline outline;
    for (const Vector3d& vertex : mesh.triangles->vertices) outline.corners_V.push_back(shown(vertex));
    return outline;
  }

  Outline operator()(const description::Plane&) const { return circle(0.0); }
  Outline operator()(const description::Heightmap&) const { return circle(0.0); }
};

}  // namespace

Outline outline_of(const TracedSolid& solid) { return std::visit(Seen{solid.X_VC}, solid.shape); }

}  // namespace cohort::tool
