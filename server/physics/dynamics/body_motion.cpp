// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/body_motion.hpp"

#include <cmath>

namespace cohort::physics {
namespace {

// Bullet knows no mass that is another one in each direction.
bool has_bullet(const Mechanism& mechanism, description::Dynamics dynamics) {
  return dynamics == description::Dynamics::bullet && mechanism.added_masses().empty();
}

}  // namespace

BodyMotion::BodyMotion(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM)
    : mechanism_(&mechanism),
      bullet_(has_bullet(mechanism, dynamics) ? std::make_unique<BulletBody>(mechanism) : nullptr),
      state_(bullet_ ? BodyState(mechanism, bullet_->memory()) : BodyState(mechanism)),
      X_WS_(mechanism.segments().size()) {
  place(X_WM);
}

void BodyMotion::update_poses() {
  for (std::size_t s = 0; s < X_WS_.size(); ++s) {
    const Segment& segment = mechanism_->segments()[s];
    if (segment.motion == Motion::free) {
      const Eigen::Quaterniond rotation = state_.root_rotation();
      X_WS_[s] = {reference() - rotation * segment.centre_S, rotation};
      continue;
    }
    const Pose& X_WP = segment.parent < 0 ? X_WM_ : X_WS_[static_cast<std::size_t>(segment.parent)];
    X_WS_[s] = moved_by_joint(segment, X_WP * segment.X_PS, state_.coordinates(segment.first_coordinate));
  }
  if (!mechanism_->has_free_root()) state_.set_reference(X_WS_[0].position);
}

Pose BodyMotion::link_pose(std::size_t link) const {
  const Mechanism::LinkPlace& place = mechanism_->link(link);
  return segment_pose(place.segment) * place.X_SL;
}

Twist BodyMotion::link_twist(std::size_t link) const {
  return segment_twist(mechanism_->link(link).segment, link_pose(link).position);
}

Twist BodyMotion::segment_twist(int of_segment, const Eigen::Vector3d& point_W) const {
  Twist twist{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  // Sum the velocity from the segment up to the root: each joint adds its contribution at the point.
  for (int s = of_segment; s >= 0; s = mechanism_->segments()[static_cast<std::size_t>(s)].parent) {
    const Segment& segment = mechanism_->segments()[static_cast<std::size_t>(s)];
    const Pose& X_WS = segment_pose(s);
    const Spatial joint = motion_at_joint(segment, X_WS.orientation, velocities() + segment.first_dof);
    const Eigen::Vector3d pivot_W = segment.motion == Motion::free ? reference() : X_WS.position;
    twist.angular_W += joint.angular;
    twist.linear_W += joint.linear;
    twist.linear_W += joint.angular.cross(point_W - pivot_W);
  }
  return twist;
}

double BodyMotion::greatest_speed(double reach) const {
  double sum = 0.0;
  for (const Segment& segment : mechanism_->segments()) {
    const double* v = velocities() + segment.first_dof;
    const auto speed_of = [&](int first, int last) {
      double speed = 0.0;
      for (int i = first; i < last; ++i) speed += std::abs(v[i]);
      return speed;
    };
    const int turning = turning_dofs_of(segment.motion);
    sum += reach * speed_of(0, turning) + speed_of(turning, segment.dofs);
  }
  return sum;
}

double BodyMotion::joint_position(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  return place.dofs == 0 ? 0.0 : *state_.coordinates(place.first_coordinate);
}

double BodyMotion::joint_velocity(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  return place.dofs == 0 ? 0.0 : velocities()[place.first_dof];
}

void BodyMotion::place(const Pose& X_WM) {
  const Segment& root = mechanism_->segments()[0];
  const Pose X_WS = X_WM * root.X_PS;
  X_WM_ = X_WM;
  state_.set_root_rotation(X_WS.orientation);
  state_.set_reference(mechanism_->has_free_root() ? X_WS * root.centre_S : X_WS.position);
  stop();
  update_poses();
}

void BodyMotion::set_root_twist(const Twist& twist) {
  const Eigen::Vector3d to_reference_W = reference() - link_pose(0).position;
  const Eigen::Vector3d linear_W = twist.linear_W + twist.angular_W.cross(to_reference_W);
  std::copy_n(twist.angular_W.data(), 3, state_.velocities());
  std::copy_n(linear_W.data(), 3, state_.velocities() + 3);
}

void BodyMotion::set_joint_state(std::size_t joint, std::span<const double> coordinates,
                                 std::span<const double> velocities) {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  double* const v = state_.velocities() + place.first_dof;
  std::copy(velocities.begin(), velocities.end(), v);
  constexpr int dofs_of_ball = 3;
  if (place.dofs == dofs_of_ball) {
    const Eigen::Quaterniond& axes = mechanism_->segments()[static_cast<std::size_t>(place.segment)].principal_axes;
    const Eigen::Quaterniond to_axes = axes.conjugate();
    const Eigen::Quaterniond rotation = to_axes * Eigen::Quaterniond(coordinates.data()) * axes;
    std::copy_n(rotation.coeffs().data(), 4, state_.coordinates(place.first_coordinate));
    const Eigen::Vector3d turned = to_axes * Eigen::Vector3d(v[0], v[1], v[2]);
    std::copy_n(turned.data(), 3, v);
  } else {
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      *state_.coordinates(place.first_coordinate + static_cast<int>(i)) = coordinates[i];
  }
  for (const auto& [dof, leader, multiplier, offset] : mechanism_->followers()) {
    if (leader != place.first_dof) continue;
    const int coordinate = mechanism_->dofs()[static_cast<std::size_t>(leader)].coordinate;
    *state_.coordinates(mechanism_->dofs()[static_cast<std::size_t>(dof)].coordinate) =
        multiplier * *state_.coordinates(coordinate) + offset;
    state_.velocities()[dof] = multiplier * state_.velocities()[leader];
  }
  update_poses();
}

}  // namespace cohort::physics
