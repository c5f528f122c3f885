// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "server/physics/mechanism/body_state.hpp"

class btMatrix3x3;
class btMultiBody;
template <typename T>
class btAlignedObjectArray;

namespace cohort::physics {

/// A body of Bullet that owns the state of one of Cohort's bodies. Bullet's articulated-body algorithm (Featherstone)
/// computes the velocities and, on request, how they respond to impulses. Nothing else of Bullet moves it.
///
/// Bullet has the same velocities in the same order: angular and linear velocity of a free root's centre of mass in
/// world axes, then those of each joint. Its frames are those of the segments, with their origins at the centres of
/// mass.
class BulletBody {
 public:
  explicit BulletBody(const Mechanism& mechanism);
  ~BulletBody();
  BulletBody(const BulletBody&) = delete;
  BulletBody& operator=(const BulletBody&) = delete;

  /// Returns pointers to the body's state, valid as long as this object.
  BodyState::Memory memory();

  /// Computes the change of the velocities in one `step` [s] into `change`. If `responses` is not null, also computes
  /// the changes by a unit impulse along each dof into it, with rows `stride` apart. The body is taken at its present
  /// state, with its segments at `X_WS`, under `gravity` [m/s^2] and the joint `efforts` by dof [N] or [N m]. Does not
  /// change the state.
  void solve(const std::vector<Pose>& X_WS, const Eigen::Vector3d& gravity, const double* efforts, double step,
             double* change, double* responses);

 private:
  void place_links(const std::vector<Pose>& X_WS);
  Eigen::Matrix<double, 6, 6> response_of_base(const btAlignedObjectArray<btMatrix3x3>& left) const;

  const Mechanism* mechanism_;
  std::unique_ptr<btMultiBody> body_;
  int first_link_;  // segment that is Bullet's link 0; a free root is Bullet's base
  int first_dof_;   // in Bullet's velocities, where six of a fixed base come first
};

}  // namespace cohort::physics
