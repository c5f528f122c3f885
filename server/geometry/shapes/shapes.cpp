// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/core/infinity.hpp"
#include "server/geometry/shapes/height_field.hpp"
#include "server/geometry/shapes/mesh_surface.hpp"

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
using Eigen::Vector3d;

Vector3d half_extents(const Box& box, const Eigen::Matrix3d& rotation) {
  return rotation.cwiseAbs() * (0.5 * box.size);
}
Vector3d half_extents(const Sphere& sphere, const Eigen::Matrix3d&) { return Vector3d::Constant(sphere.radius); }
Vector3d half_extents(const Cylinder& cylinder, const Eigen::Matrix3d& rotation) {
  const Vector3d axis = rotation.col(2);
  Vector3d extents;
  for (int i = 0; i < 3; ++i) {
    const double disc = std::sqrt(std::max(0.0, 1.0 - axis[i] * axis[i]));
    extents[i] = cylinder.radius * disc + 0.5 * cylinder.length * std::abs(axis[i]);
  }
  return extents;
}
Vector3d half_extents(const Capsule& capsule, const Eigen::Matrix3d& rotation) {
  return 0.5 * capsule.length * rotation.col(2).cwiseAbs() + Vector3d::Constant(capsule.radius);
}
Vector3d half_extents(const Ellipsoid& ellipsoid, const Eigen::Matrix3d& rotation) {
  return (rotation * ellipsoid.radii.asDiagonal()).rowwise().norm();
}
Vector3d half_extents(const Plane&, const Eigen::Matrix3d&) { return Vector3d::Constant(infinity); }

template <class Centred>
Bounds bounds(const Centred& shape, const Pose& X_WC) {
  const Vector3d half = half_extents(shape, X_WC.orientation.toRotationMatrix());
  return {X_WC.position - half, X_WC.position + half};
}
Bounds bounds(const Mesh& mesh, const Pose& X_WC) {
  Bounds box{Vector3d::Constant(infinity), Vector3d::Constant(-infinity)};
  for (const Vector3d& vertex : mesh.triangles->vertices) {
    const Vector3d vertex_W = X_WC * vertex;
    box.lower = box.lower.cwiseMin(vertex_W);
    box.upper = box.upper.cwiseMax(vertex_W);
  }
  return box;
}
Bounds bounds(const Heightmap& map, const Pose& X_WC) { return bounds_of(*map.grid, X_WC); }

RayEntry enter(const Box& box, const Vector3d& origin, const Vector3d& direction) {
  const Vector3d half = 0.5 * box.size;
  double first = -infinity;
  double last = infinity;
  int first_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (std::abs(origin[axis]) > half[axis]) return {};
      continue;
    }
    double in = (-half[axis] - origin[axis]) / direction[axis];
    double out = (half[axis] - origin[axis]) / direction[axis];
    if (in > out) std::swap(in, out);
    if (in > first) {
      first = in;
      first_axis = axis;
    }
    last = std::min(last, out);
  }
  if (first > last || last < 0.0) return {};
  if (first <= 0.0) return {0.0, Vector3d::Zero()};
  Vector3d normal = Vector3d::Zero();
  normal[first_axis] = direction[first_axis] > 0.0 ? -1.0 : 1.0;
  return {first, normal};
}

RayEntry enter(const Sphere& sphere, const Vector3d& origin, const Vector3d& direction) {
  const double c = origin.squaredNorm() - sphere.radius * sphere.radius;
  if (c <= 0.0) return {0.0, Vector3d::Zero()};
  const double b = origin.dot(direction);
  const double discriminant = b * b - c;
  if (b >= 0.0 || discriminant < 0.0) return {};
  const double distance = -b - std::sqrt(discriminant);
  return {distance, (origin + distance * direction) / sphere.radius};
}

RayEntry enter(const Cylinder& cylinder, const Vector3d& origin, const Vector3d& direction) {
  const double half = 0.5 * cylinder.length;
  const double radius_squared = cylinder.radius * cylinder.radius;
  const double a = direction.head<2>().squaredNorm();
  const double b = origin.head<2>().dot(direction.head<2>());
  const double c = origin.head<2>().squaredNorm() - radius_squared;
  if (c <= 0.0 && std::abs(origin.z()) <= half) return {0.0, Vector3d::Zero()};

  if (c > 0.0) {
    const double discriminant = b * b - a * c;
    if (b >= 0.0 || discriminant < 0.0) return {};  // moves away from the axis, or passes beside it
    const double distance = (-b - std::sqrt(discriminant)) / a;
    const double z = origin.z() + distance * direction.z();
    if (std::abs(z) <= half) {
      const Vector3d at = origin + distance * direction;
      return {distance, Vector3d(at.x(), at.y(), 0.0) / cylinder.radius};
    }
  }
  // Only the end cap that faces the origin is left.
  if (std::abs(origin.z()) <= half || origin.z() * direction.z() >= 0.0) return {};
  const double end = origin.z() > 0.0 ? half : -half;
  const double distance = (end - origin.z()) / direction.z();
  const Eigen::Vector2d at = origin.head<2>() + distance * direction.head<2>();
  if (at.squaredNorm() > radius_squared) return {};
  return {distance, Vector3d(0.0, 0.0, end > 0.0 ? 1.0 : -1.0)};
}

RayEntry enter(const Capsule& capsule, const Vector3d& origin, const Vector3d& direction) {
  const double half = 0.5 * capsule.length;
  const double c = origin.head<2>().squaredNorm() - capsule.radius * capsule.radius;
  double z = origin.z();
  if (c > 0.0) {
    const double a = direction.head<2>().squaredNorm();
    const double b = origin.head<2>().dot(direction.head<2>());
    const double discriminant = b * b - a * c;
    if (b >= 0.0 || discriminant < 0.0) return {};  // moves away from the axis, or passes beside it
    const double distance = (-b - std::sqrt(discriminant)) / a;
    const Vector3d at = origin + distance * direction;
    if (std::abs(at.z()) <= half) return {distance, Vector3d(at.x(), at.y(), 0.0) / capsule.radius};
    z = at.z();
  } else if (std::abs(z) <= half) {
    return {0.0, Vector3d::Zero()};
  }
  // Beyond an end, the ray can only enter through the half sphere there.
  return enter(Sphere{capsule.radius}, origin - Vector3d(0.0, 0.0, z > 0.0 ? half : -half), direction);
}

RayEntry enter(const Ellipsoid& ellipsoid, const Vector3d& origin, const Vector3d& direction) {
  // Scaled by its radii, it is a unit sphere.
  const Vector3d o = origin.cwiseQuotient(ellipsoid.radii);
  const Vector3d d = direction.cwiseQuotient(ellipsoid.radii);
  const double c = o.squaredNorm() - 1.0;
  if (c <= 0.0) return {0.0, Vector3d::Zero()};
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double discriminant = b * b - a * c;
  if (b >= 0.0 || discriminant < 0.0) return {};
  const double distance = (-b - std::sqrt(discriminant)) / a;
  return {distance, (o + distance * d).cwiseQuotient(ellipsoid.radii).normalized()};
}

RayEntry enter(const Plane& plane, const Vector3d& origin, const Vector3d& direction) {
  const double height = plane.normal.dot(origin);
  if (height <= 0.0) return {0.0, Vector3d::Zero()};
  const double descent = -plane.normal.dot(direction);
  if (descent <= 0.0) return {};
  return {height / descent, plane.normal};
}

RayEntry enter(const Mesh& mesh, const Vector3d& origin, const Vector3d& direction, double range) {
  return MeshSurface(mesh).cast_ray(origin, direction, range);
}

RayEntry enter(const Heightmap& map, const Vector3d& origin, const Vector3d& direction, double range) {
  return cast_ray(*map.grid, origin, direction, range);
}

template <class Closed>
RayEntry enter(const Closed& shape, const Vector3d& origin, const Vector3d& direction, double) {
  return enter(shape, origin, direction);
}

}  // namespace

Bounds bounds_of_disc(const Pose& X_WS, double radius) {
  constexpr double rounding = 1e-9;
  const Vector3d normal_W = X_WS.orientation * Vector3d::UnitZ();
  Vector3d half;
  for (int i = 0; i < 3; ++i) half[i] = radius * std::sqrt(std::max(0.0, 1.0 - normal_W[i] * normal_W[i]));
  return Bounds{X_WS.position - half, X_WS.position + half}.grown_by(rounding);
}

double radius_of(const Shape& shape) {
  struct Radius {
    double operator()(const Box& box) const { return 0.5 * box.size.norm(); }
    double operator()(const Sphere& sphere) const { return sphere.radius; }
    double operator()(const Cylinder& cylinder) const {
      return std::sqrt(cylinder.radius * cylinder.radius + 0.25 * cylinder.length * cylinder.length);
    }
    double operator()(const description::Capsule& capsule) const { return capsule.radius + 0.5 * capsule.length; }
    double operator()(const description::Ellipsoid& ellipsoid) const { return ellipsoid.radii.maxCoeff(); }
    double operator()(const description::Mesh& mesh) const {
      double radius = 0.0;
      for (const Vector3d& vertex : mesh.triangles->vertices) radius = std::max(radius, vertex.norm());
      return radius;
    }
    double operator()(const Plane&) const { return infinity; }
    double operator()(const description::Heightmap&) const { return infinity; }
  };
  return std::visit(Radius{}, shape);
}

double half_thickness_of(const Shape& shape) {
  struct HalfThickness {
    double operator()(const Box& box) const { return 0.5 * box.size.minCoeff(); }
    double operator()(const Sphere& sphere) const { return sphere.radius; }
    double operator()(const Cylinder& cylinder) const { return std::min(cylinder.radius, 0.5 * cylinder.length); }
    double operator()(const description::Capsule& capsule) const { return capsule.radius; }
    double operator()(const description::Ellipsoid& ellipsoid) const { return ellipsoid.radii.minCoeff(); }
    double operator()(const description::Mesh& mesh) const {
      const Bounds bounds = bounds_of(mesh, Pose{});
      return 0.5 * (bounds.upper - bounds.lower).minCoeff();
    }
    double operator()(const Plane&) const { return infinity; }
    double operator()(const description::Heightmap&) const { return infinity; }
  };
  return std::visit(HalfThickness{}, shape);
}

Bounds bounds_of(const Shape& shape, const Pose& X_WC) {
  return std::visit([&](const auto& s) { return bounds(s, X_WC); }, shape);
}

RayEntry cast_ray(const Shape& shape, const Vector3d& origin, const Vector3d& direction, double range) {
  return std::visit([&](const auto& s) { return enter(s, origin, direction, range); }, shape);
}

}  // namespace cohort::geometry
