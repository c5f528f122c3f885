// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/core/pose.hpp"
#include "server/description/shape.hpp"

namespace cohort::geometry {

/// Mass properties of a solid with uniform density.
struct MassProperties {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre, along the axes of the frame [kg m^2]
};

/// Returns the mass properties of a shape in its frame C. They are closed forms, or for a mesh exact integrals over the
/// enclosed volume (Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", J. Math. Stat. 1, 2005).
/// Planes and height maps have mass 0. `density` in kg/m^3.
MassProperties mass_properties(const description::Shape& shape, double density);

/// Returns the properties of the same solid in frame A, in which the pose of its frame is X_AB.
MassProperties moved(const MassProperties& part, const Pose& X_AB);

/// Returns the properties of several solids together, all in one frame. Overlapping volumes count twice.
MassProperties together(const std::vector<MassProperties>& parts);

}  // namespace cohort::geometry
