// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/dynamics/joint_axes.hpp"

namespace cohort::physics {

/// Computes the bias forces of a body: the generalised forces that its motion and gravity require at zero acceleration.
/// Recursive Newton-Euler algorithm (Featherstone, "Rigid body dynamics algorithms", 2008, chapter 5), in world axes
/// about the body's reference point.
///
/// One object serves many bodies one after the other and reuses its memory.
class BiasForces {
 public:
  /// The inertia of one segment about the reference point.
  struct SpatialInertia {
    Eigen::Matrix3d inertia;  ///< [kg m^2]
    Eigen::Vector3d moment;   ///< first moment of mass: mass times the offset of the centre [kg m]
    double mass = 0.0;        ///< [kg]
  };

  /// Prepares for the present segment poses of `body`. `axes` are its joint axes and must outlive the use of this
  /// object.
  void set_up(const BodyMotion& body, const std::vector<Spatial>& axes);
  const std::vector<SpatialInertia>& inertias() const { return inertias_; }  ///< by segment
  /// Returns the added mass of each segment about the reference point; empty if no segment has any.
  const std::vector<SpatialMatrix>& added_masses() const { return added_masses_; }

  /// Computes the generalised bias force by dof [N] or [N m] for these velocities under `gravity` [m/s^2]. The
  /// gyroscopic torque of a body that turns freely is not included: `integrate` handles its rotation. Added mass has
  /// inertia but no weight (Fossen, "Handbook of marine craft hydrodynamics and motion control", 2011, chapter 6).
  void find(const double* velocities, const Eigen::Vector3d& gravity, double* forces);

 private:
  struct SegmentMotion {
    Spatial velocity;
    Spatial acceleration;
    Spatial force;
  };
  void move_outwards(const double* velocities, const Eigen::Vector3d& gravity);
  void take_force(SegmentMotion& motion, const SpatialInertia& segment) const;
  static void add_force_of_fluid(SegmentMotion& motion, const SpatialMatrix& added_mass,
                                 const Eigen::Vector3d& gravity);

  const Mechanism* mechanism_ = nullptr;
  const std::vector<Spatial>* axes_ = nullptr;  // by dof
  std::vector<SpatialInertia> inertias_;
  std::vector<SpatialMatrix> added_masses_;
  std::vector<SegmentMotion> motions_;  // by segment
};

}  // namespace cohort::physics
