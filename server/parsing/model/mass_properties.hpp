#pragma once

#include <vector>

#include "server/description/model.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Of a solid of the same density everywhere.
struct MassProperties {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre, along the axes of the frame [kg m^2]
};

/// Of a shape in its own frame C: closed forms, and of a mesh the exact integrals over the volume that its triangles
/// enclose (Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", J. Math. Stat. 1, 2005). Planes
/// and height maps have none: mass 0. `density` in kg/m^3.
MassProperties mass_properties(const Shape& shape, double density);

/// The same solid in frame A, where its own frame stands at X_AB.
MassProperties moved(const MassProperties& part, const Pose& X_AB);

/// Of several solids together, all in one frame. Where two overlap, both count.
MassProperties together(const std::vector<MassProperties>& parts);

}  // namespace cohort::parsing
