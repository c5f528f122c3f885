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

/// Where one instance of a model is and how it moves: its state, and the poses that follow from it. integration.hpp
/// moves it on.
class BodyMotion {
 public:
  /// The mechanism is shared and must outlive this; X_WM places the model with all its joints at zero.
  BodyMotion(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM);
  BodyMotion(const BodyMotion&) = delete;
  BodyMotion& operator=(const BodyMotion&) = delete;

  const Mechanism& mechanism() const { return *mechanism_; }
  /// What has the state and its dynamics, nullptr if they are our own.
  BulletBody* bullet() const { return bullet_.get(); }

  // The state: what decides how the body goes on.
  /// Call `update_poses` after changes of the root or of coordinates.
  BodyState& state() { return state_; }
  const double* velocities() const { return state_.velocities(); }
  double coordinate(const Dof& dof) const { return *state_.coordinates(dof.coordinate); }
  /// Where the spatial velocities of this body are taken: the centre of mass of the root segment, or the origin of a
  /// root that is tied to the world [m].
  Eigen::Vector3d reference() const { return state_.reference(); }

  /// X_WM where it was placed: what joints to the world hold on to.
  const Pose& model_pose() const { return X_WM_; }
  const std::vector<Pose>& segment_poses() const { return X_WS_; }
  const Pose& segment_pose(int segment) const { return X_WS_[static_cast<std::size_t>(segment)]; }
  Pose link_pose(std::size_t link) const;  ///< X_WL
  Twist link_twist(std::size_t link) const;
  /// Returns the velocity of the segment at a point.
  Twist segment_twist(int segment, const Eigen::Vector3d& point_W) const;
  /// No point within `reach` of all joints it hangs on, and of the reference, moves faster [m/s].
  double greatest_speed(double reach) const;
  double joint_position(std::size_t joint) const;
  double joint_velocity(std::size_t joint) const;

  /// Puts the model at X_WM, at rest, with its joints as they are.
  void place(const Pose& X_WM);
  /// Puts a body whose root is free elsewhere, as it is and moves.
  void move(const Eigen::Vector3d& way_W) {
    state_.set_reference(reference() + way_W);
    update_poses();
  }
  /// All velocities become zero.
  void stop() { std::fill_n(state_.velocities(), mechanism_->dof_count(), 0.0); }
  void set_root_twist(const Twist& twist);
  void set_joint_state(std::size_t joint, std::span<const double> coordinates, std::span<const double> velocities);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    BodyState::visit(self.state_, visit);
  }
  /// After the state was changed through `state` or `visit_state`.
  void update_poses();

 private:
  const Mechanism* mechanism_;
  Pose X_WM_;  // of a root that is tied to the world
  std::unique_ptr<BulletBody> bullet_;
  BodyState state_;
  std::vector<Pose> X_WS_;  // follow from the state
};

}  // namespace cohort::physics
