#pragma once

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/dynamics/joint_axes.hpp"

namespace cohort::physics {

/// What the motion of a body and gravity take of each dof if nothing accelerates: recursive Newton-Euler (Featherstone,
/// "Rigid body dynamics algorithms", 2008, chapter 5), in world axes about the body's reference point.
///
/// One object serves many bodies one after the other; it keeps its memory.
class BiasForces {
 public:
  /// Of one segment, about the reference.
  struct SpatialInertia {
    Eigen::Matrix3d inertia;  ///< [kg m^2]
    Eigen::Vector3d moment;   ///< mass times the centre's offset from the reference [kg m]
    double mass = 0.0;        ///< [kg]
  };

  /// For where the segments of `body` are. `axes`: its, which must last as long as the rest is used.
  void set_up(const BodyMotion& body, const std::vector<Spatial>& axes);
  const std::vector<SpatialInertia>& inertias() const { return inertias_; }  ///< by segment

  /// For velocities, under `gravity` [m/s^2]: the generalised force, by dof [N] or [N m]. The gyroscopic torque of a
  /// body on its own is not in it: how that turns is left to `integrate`.
  void find(const double* velocities, const Eigen::Vector3d& gravity, double* forces);

 private:
  struct SegmentMotion {
    Spatial velocity;
    Spatial acceleration;
    Spatial force;
  };
  void move_outwards(const double* velocities, const Eigen::Vector3d& gravity);
  void take_force(SegmentMotion& motion, const SpatialInertia& segment) const;

  const Mechanism* mechanism_ = nullptr;
  const std::vector<Spatial>* axes_ = nullptr;  // by dof
  std::vector<SpatialInertia> inertias_;
  std::vector<SegmentMotion> motions_;  // by segment
};

}  // namespace cohort::physics
