#pragma once

#include <memory>
#include <vector>

#include "server/physics/mechanism/body_state.hpp"

class btMatrix3x3;
class btMultiBody;
template <typename T>
class btAlignedObjectArray;

namespace cohort::physics {

/// A body of Bullet, which owns the state of one of ours, and its Featherstone: velocities by the articulated-body
/// algorithm, and how they answer impulses. Nothing else of Bullet moves it.
///
/// Bullet has the same velocities in the same order: of a free root angular and linear, of its centre of mass, in world
/// axes, then each joint's. Its frames are those of the segments, with their origins at the centres of mass.
class BulletBody {
 public:
  explicit BulletBody(const Mechanism& mechanism);
  ~BulletBody();
  BulletBody(const BulletBody&) = delete;
  BulletBody& operator=(const BulletBody&) = delete;

  /// Of the body, for as long as this is.
  BodyState::Memory memory();

  /// For the body as it is, with its segments at `X_WS`, under `gravity` [m/s^2] and with the `efforts` of the joints,
  /// by dof [N] or [N m]: by how much velocities change in one `step` [s] into `change`, and the change by a unit
  /// impulse along each dof into `responses`, each `stride` after the one before. The state stays as it is.
  void solve(const std::vector<Pose>& X_WS, const Eigen::Vector3d& gravity, const double* efforts, double step,
             double* change, double* responses);

 private:
  void place_links(const std::vector<Pose>& X_WS);
  Eigen::Matrix<double, 6, 6> response_of_base(const btAlignedObjectArray<btMatrix3x3>& left) const;

  const Mechanism* mechanism_;
  std::unique_ptr<btMultiBody> body_;
  int first_link_;  // segment that is Bullet's link 0: that after a free root, which is its base
  int first_dof_;   // in Bullet's velocities: the six of a base that is fixed come before ours
};

}  // namespace cohort::physics
