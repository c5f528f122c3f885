// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "server/physics/mechanism/body_state.hpp"
#include "server/physics/mechanism/bullet_body.hpp"
#include "server/physics/mechanism/mechanism.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// The state of one instance of a model (pose and velocity), and the poses that follow from it. integration.hpp
/// advances it.
class BodyMotion {
 public:
  /// Places the model at X_WM with all its joints at zero. The mechanism is shared and must outlive this.
  BodyMotion(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM);
  BodyMotion(const BodyMotion&) = delete;
  BodyMotion& operator=(const BodyMotion&) = delete;

  const Mechanism& mechanism() const { return *mechanism_; }
  /// Returns Bullet's body that holds the state and computes the dynamics, or nullptr if the dynamics are Cohort's own.
  BulletBody* bullet() const { return bullet_.get(); }

  // Returns the state, which determines the further motion of the body. Call `update_poses` after changes of the root
  // or of coordinates.
  BodyState& state() { return state_; }
  const BodyState& state() const { return state_; }
  const double* velocities() const { return state_.velocities(); }
  double coordinate(const Dof& dof) const { return *state_.coordinates(dof.coordinate); }
  /// Returns the reference point of this body's spatial velocities [m]: the centre of mass of the root segment, or the
  /// origin of a root that is anchored to the world.
  Eigen::Vector3d reference() const { return state_.reference(); }

  /// Returns the X_WM at which the model was placed; joints to the world are anchored there.
  const Pose& model_pose() const { return X_WM_; }
  const std::vector<Pose>& segment_poses() const { return X_WS_; }
  const Pose& segment_pose(int segment) const { return X_WS_[static_cast<std::size_t>(segment)]; }
  Pose link_pose(std::size_t link) const;  ///< X_WL
  Twist link_twist(std::size_t link) const;
  /// Returns the velocity of the segment's point at `point_W`.
  Twist segment_twist(int segment, const Eigen::Vector3d& point_W) const;
  /// Returns an upper bound on the speed [m/s] of the body's points. It holds for points within `reach` of the
  /// reference point and of all joints between the point and the root.
  double greatest_speed(double reach) const;
  double joint_position(std::size_t joint) const;
  double joint_velocity(std::size_t joint) const;

  /// Places the model at X_WM at rest, with its joints unchanged.
  void place(const Pose& X_WM);
  /// Translates a body with a free root; orientation and velocities stay the same.
  void move(const Eigen::Vector3d& way_W) {
    state_.set_reference(reference() + way_W);
    update_poses();
  }
  /// Sets all velocities to zero.
  void stop() { std::fill_n(state_.velocities(), mechanism_->dof_count(), 0.0); }
  void set_root_twist(const Twist& twist);
  void set_joint_state(std::size_t joint, std::span<const double> coordinates, std::span<const double> velocities);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    BodyState::visit(self.state_, visit);
  }
  /// Updates the poses after the state was changed through `state` or `visit_state`.
  void update_poses();

 private:
  const Mechanism* mechanism_;
  Pose X_WM_;  // pose of a root that is anchored to the world
  std::unique_ptr<BulletBody> bullet_;
  BodyState state_;
  std::vector<Pose> X_WS_;  // follow from the state
};

}  // namespace cohort::physics
