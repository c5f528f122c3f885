// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/geometry/shapes/shapes.hpp"

namespace cohort::physics {

/// The part of a solid below a level surface, and its waterplane, the section of the solid at that surface.
struct SubmergedPart {
  double volume = 0.0;  ///< [m^3]
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  // The waterplane:
  double area = 0.0;  ///< [m^2]
  Eigen::Vector3d area_centre_W = Eigen::Vector3d::Zero();
  Eigen::Matrix2d second_moment_W = Eigen::Matrix2d::Zero();  ///< ∫ r r^T dA in x and y, about its centre [m^4]

  /// Adds the part of another solid below the same surface.
  void add(const SubmergedPart& other);
};

/// A solid that may float. Immutable. Spheres and ellipsoids are computed in closed form, as images of a cap of the
/// unit ball. Boxes and convex meshes are exact: they are polyhedra, and the surface cuts each of their triangles
/// (Catto, "Exact buoyancy for polyhedra", in: Game programming gems 6, 2006). Cylinders and capsules are polyhedra of
/// 64 sides with the same volume; their submerged part differs from that of the round shape by at most 0.2 % of the
/// volume.
class FloatingShape {
 public:
  /// Throws std::invalid_argument if a mesh spans no volume.
  explicit FloatingShape(const geometry::Shape& shape);

  /// Returns false for planes and height maps.
  bool has_volume() const { return whole_volume_ > 0.0; }
  /// Returns the part below `level` with the shape at X_WC.
  SubmergedPart below(double level, const Pose& X_WC) const;

 private:
  void take(const description::TriangleMesh& polyhedron);
  void take_round(const description::TriangleMesh& polyhedron, double volume);
  SubmergedPart ellipsoid_below(double level, const Pose& X_WC) const;
  SubmergedPart polyhedron_below(double level, const Pose& X_WC) const;

  double whole_volume_ = 0.0;
  Eigen::Vector3d whole_centre_ = Eigen::Vector3d::Zero();
  double reach_ = 0.0;                               // greatest distance of a point from the origin
  Eigen::Vector3d radii_ = Eigen::Vector3d::Zero();  // for an ellipsoid
  description::TriangleMesh polyhedron_;             // for all other shapes
};

}  // namespace cohort::physics
