#pragma once

#include "server/geometry/shapes/shapes.hpp"

namespace cohort::physics {

/// What of a solid is below a level surface, and what that cuts out of it.
struct SubmergedPart {
  double volume = 0.0;  ///< [m^3]
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  // Of the section with the surface:
  double area = 0.0;  ///< [m^2]
  Eigen::Vector3d area_centre_W = Eigen::Vector3d::Zero();
  Eigen::Matrix2d second_moment_W = Eigen::Matrix2d::Zero();  ///< ∫ r r^T dA in x and y, about its centre [m^4]
};

/// A solid that may float. Spheres and ellipsoids by the closed form of a cap, as images of the unit ball; boxes and
/// convex meshes exactly, as polyhedra of which each triangle is cut by the surface (Catto, "Exact buoyancy for
/// polyhedra", in: Game programming gems 6, 2006); cylinders and capsules as polyhedra of 64 sides with the same
/// volume, whose submerged part is within 0.2 % of the volume of that of the round ones. Constant.
class FloatingShape {
 public:
  /// Throws std::invalid_argument if a mesh spans no volume.
  explicit FloatingShape(const geometry::Shape& shape);

  /// Planes and height maps have none.
  bool has_volume() const { return whole_volume_ > 0.0; }
  /// At X_WC, of what is below `level`.
  SubmergedPart below(double level, const Pose& X_WC) const;

 private:
  void take(const description::TriangleMesh& polyhedron);
  void take_round(const description::TriangleMesh& polyhedron, double volume);
  SubmergedPart ellipsoid_below(double level, const Pose& X_WC) const;
  SubmergedPart polyhedron_below(double level, const Pose& X_WC) const;

  double whole_volume_ = 0.0;
  Eigen::Vector3d whole_centre_ = Eigen::Vector3d::Zero();
  double reach_ = 0.0;                               // no point is further from the origin
  Eigen::Vector3d radii_ = Eigen::Vector3d::Zero();  // of an ellipsoid
  description::TriangleMesh polyhedron_;             // of all others
};

}  // namespace cohort::physics
