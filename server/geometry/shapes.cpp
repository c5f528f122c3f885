#include "server/geometry/shapes.hpp"

#include <cmath>
#include <utility>

namespace cohort::geometry {
namespace {

using description::Box;
using description::Cylinder;
using description::Plane;
using description::Sphere;
using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

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
Vector3d half_extents(const Plane&, const Eigen::Matrix3d&) { return Vector3d::Constant(infinity); }

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
    if (b >= 0.0 || discriminant < 0.0) return {};  // leads away from the axis, or passes beside it
    const double distance = (-b - std::sqrt(discriminant)) / a;
    const double z = origin.z() + distance * direction.z();
    if (std::abs(z) <= half) {
      const Vector3d at = origin + distance * direction;
      return {distance, Vector3d(at.x(), at.y(), 0.0) / cylinder.radius};
    }
  }
  // Only an end is left: the one that faces the origin.
  if (std::abs(origin.z()) <= half || origin.z() * direction.z() >= 0.0) return {};
  const double end = origin.z() > 0.0 ? half : -half;
  const double distance = (end - origin.z()) / direction.z();
  const Eigen::Vector2d at = origin.head<2>() + distance * direction.head<2>();
  if (at.squaredNorm() > radius_squared) return {};
  return {distance, Vector3d(0.0, 0.0, end > 0.0 ? 1.0 : -1.0)};
}

RayEntry enter(const Plane& plane, const Vector3d& origin, const Vector3d& direction) {
  const double height = plane.normal.dot(origin);
  if (height <= 0.0) return {0.0, Vector3d::Zero()};
  const double descent = -plane.normal.dot(direction);
  if (descent <= 0.0) return {};
  return {height / descent, plane.normal};
}

}  // namespace

Bounds bounds_of(const Shape& shape, const Pose& X_WC) {
  const Eigen::Matrix3d rotation = X_WC.orientation.toRotationMatrix();
  const Vector3d half = std::visit([&](const auto& s) { return half_extents(s, rotation); }, shape);
  return {X_WC.position - half, X_WC.position + half};
}

RayEntry cast_ray(const Shape& shape, const Vector3d& origin, const Vector3d& direction) {
  return std::visit([&](const auto& s) { return enter(s, origin, direction); }, shape);
}

}  // namespace cohort::geometry
