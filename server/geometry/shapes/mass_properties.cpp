// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/mass_properties.hpp"

#include <array>
#include <cassert>
#include <numbers>
#include <type_traits>

#include "server/core/is_unit.hpp"

namespace cohort::geometry {
namespace {

using namespace description;

MassProperties centred(double mass, const Eigen::Vector3d& moments) {
  return {mass, Eigen::Vector3d::Zero(), moments.asDiagonal()};
}

// Returns the inertia of a point mass at r, about the origin.
Eigen::Matrix3d point_inertia(double mass, const Eigen::Vector3d& r) {
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

MassProperties solid(const Box& box, double density) {
  const Eigen::Vector3d square = box.size.cwiseAbs2();
  const double mass = density * box.size.prod();
  return centred(
      mass, mass / 12.0 * Eigen::Vector3d(square.y() + square.z(), square.x() + square.z(), square.x() + square.y()));
}

MassProperties solid(const Ellipsoid& ellipsoid, double density) {
  const Eigen::Vector3d square = ellipsoid.radii.cwiseAbs2();
  const double mass = density * 4.0 / 3.0 * std::numbers::pi * ellipsoid.radii.prod();
  return centred(
      mass, mass / 5.0 * Eigen::Vector3d(square.y() + square.z(), square.x() + square.z(), square.x() + square.y()));
}

MassProperties solid(const Sphere& sphere, double density) {
  return solid(Ellipsoid{Eigen::Vector3d::Constant(sphere.radius)}, density);
}

MassProperties solid(const Cylinder& cylinder, double density) {
  const double r2 = cylinder.radius * cylinder.radius;
  const double mass = density * std::numbers::pi * r2 * cylinder.length;
  const double across = mass * (3.0 * r2 + cylinder.length * cylinder.length) / 12.0;
  return centred(mass, {across, across, mass * r2 / 2.0});
}

// A cylinder, and a sphere whose halves are moved apart: the centre of mass of each half is 3/8 r from the flat side.
MassProperties solid(const Capsule& capsule, double density) {
  const double r = capsule.radius;
  const double l = capsule.length;
  const MassProperties middle = solid(Cylinder{r, l}, density);
  const double ends = density * 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double across = ends * (0.4 * r * r + l * l / 4.0 + 3.0 / 8.0 * l * r);
  return centred(middle.mass + ends, middle.inertia.diagonal() + Eigen::Vector3d(across, across, ends * 0.4 * r * r));
}

// Sums tetrahedra between a point inside the mesh and each triangle, negative where the triangle faces the point.
MassProperties solid(const Mesh& mesh, double density) {
  const TriangleMesh& surface = *mesh.triangles;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : surface.vertices)
    origin += vertex / static_cast<double>(surface.vertices.size());
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   // integral of r
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of r r^T
  for (const std::array<std::uint32_t, 3>& triangle : surface.triangles) {
    const Eigen::Vector3d a = surface.vertices[triangle[0]] - origin;
    const Eigen::Vector3d b = surface.vertices[triangle[1]] - origin;
    const Eigen::Vector3d c = surface.vertices[triangle[2]] - origin;
    const double part = a.dot(b.cross(c)) / 6.0;
    const Eigen::Vector3d sum = a + b + c;
    volume += part;
    first += part / 4.0 * sum;
    second += part / 20.0 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (!(volume > 0.0)) return {};
  const Eigen::Vector3d centre = first / volume;
  const Eigen::Matrix3d about_centre = second - volume * centre * centre.transpose();
  return {density * volume, origin + centre,
          density * (about_centre.trace() * Eigen::Matrix3d::Identity() - about_centre)};
}

MassProperties solid(const Plane&, double) { return {}; }
MassProperties solid(const Heightmap&, double) { return {}; }

}  // namespace

MassProperties mass_properties(const description::Shape& shape, double density) {
  return std::visit([&](const auto& each) { return solid(each, density); }, shape);
}

MassProperties moved(const MassProperties& part, const Pose& X_AB) {
  assert(is_unit(X_AB.orientation));
  const Eigen::Matrix3d R = X_AB.orientation.toRotationMatrix();
  return {part.mass, X_AB * part.centre, R * part.inertia * R.transpose()};
}

MassProperties together(const std::vector<MassProperties>& parts) {
  MassProperties whole;
  for (const MassProperties& part : parts) {
    whole.mass += part.mass;
    whole.centre += part.mass * part.centre;
  }
  if (!(whole.mass > 0.0)) return {};
  whole.centre /= whole.mass;
  for (const MassProperties& part : parts)
    whole.inertia += part.inertia + point_inertia(part.mass, part.centre - whole.centre);
  return whole;
}

}  // namespace cohort::geometry
