// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "server/description/model.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// The motion of the links of one body over its last step. Kept only for bodies for which it was requested, and not
/// part of the state.
class MotionRecord {
 public:
  explicit MotionRecord(const description::Model& model) : parents_(model.links.size(), none) {
    for (std::size_t i = 0; i < model.links.size(); ++i) points_.emplace_back(Eigen::Vector3d::Zero());
    is_free_.resize(model.links.size(), 1);
    for (const description::Joint& joint : model.joints) {
      if (joint.parent != description::Joint::world) parents_[joint.child] = joint.parent;
      points_[joint.child] = joint.X_LJ.position;
      is_free_[joint.child] = 0;
    }
  }

  /// Records the motion; call `before` and `after` around the integration of a step. `Body` has link_pose and
  /// link_twist of a link, and the reference point of its root.
  template <class Body>
  void before(const Body& body) {
    keep(before_, body);
    is_whole_ = false;
    for (std::size_t link = 0; link < points_.size(); ++link) {
      const Pose& X_WL = before_[link].X_WL;
      if (is_free_[link] != 0) points_[link] = X_WL.orientation.conjugate() * (body.reference() - X_WL.position);
    }
  }
  template <class Body>
  void after(const Body& body) {
    keep(after_, body);
    is_whole_ = true;
  }
  /// Forgets the last step. Called if the body was placed elsewhere or did not take part in the step.
  void forget() { is_whole_ = false; }
  bool is_whole() const { return is_whole_; }

  const Pose& pose_before(std::size_t link) const { return before_[link].X_WL; }
  /// Returns the rotation of the link during the step, in world axes.
  Eigen::Quaterniond turn(std::size_t link) const {
    return after_[link].X_WL.orientation * before_[link].X_WL.orientation.conjugate();
  }
  /// Returns the acceleration of a point fixed to the link, in world axes [m/s^2]; zero if the last step is not known.
  ///
  /// It is the sum of relative, Coriolis and centripetal accelerations over the joints from the root to the link
  /// (Craig, "Introduction to robotics", section 6.5). Poses and velocities are those at the end of the step. Only the
  /// rates of change of relative velocities, in the axes of the parent, are means over the step. A mean rate of change
  /// of the point's own velocity would have the direction of half a step ago.
  Eigen::Vector3d acceleration(std::size_t link, const Eigen::Vector3d& p_LP, double step) const {
    Eigen::Vector3d sum_W = Eigen::Vector3d::Zero();
    if (!is_whole_) return sum_W;
    const Eigen::Vector3d point_W = after_[link].X_WL * p_LP;
    for (std::size_t at = link; at != none; at = parents_[at]) sum_W += acceleration_in_parent(at, point_W, step);
    return sum_W;
  }

 private:
  static constexpr auto none = static_cast<std::size_t>(-1);

  struct LinkMotion {
    Pose X_WL;
    Twist twist;
  };

  template <class Body>
  void keep(std::vector<LinkMotion>& motions, const Body& body) const {
    motions.resize(points_.size());
    for (std::size_t link = 0; link < points_.size(); ++link)
      motions[link] = {body.link_pose(link), body.link_twist(link)};
  }
  static Eigen::Vector3d velocity(const LinkMotion& motion, const Eigen::Vector3d& point_W) {
    return motion.twist.linear_W + motion.twist.angular_W.cross(point_W - motion.X_WL.position);
  }
  // Returns the velocity of the link's point relative to the parent, which may be the world.
  Twist relative_twist(const std::vector<LinkMotion>& motions, std::size_t link) const {
    const Eigen::Vector3d point_W = motions[link].X_WL * points_[link];
    Twist twist{motions[link].twist.angular_W, velocity(motions[link], point_W)};
    if (parents_[link] == none) return twist;
    const LinkMotion& parent = motions[parents_[link]];
    twist.angular_W -= parent.twist.angular_W;
    twist.linear_W -= velocity(parent, point_W);
    return twist;
  }
  // Returns the acceleration of a point that moves with the link, without that of the parent's point at the same place.
  Eigen::Vector3d acceleration_in_parent(std::size_t link, const Eigen::Vector3d& point_W, double step) const {
    const bool has_parent = parents_[link] != none;
    const Twist now = relative_twist(after_, link);
    const Twist then = relative_twist(before_, link);
    const Eigen::Quaterniond turned = has_parent ? turn(parents_[link]) : Eigen::Quaterniond::Identity();
    const Eigen::Vector3d linear_W = (now.linear_W - turned * then.linear_W) / step;
    const Eigen::Vector3d angular_W = (now.angular_W - turned * then.angular_W) / step;
    const Eigen::Vector3d arm_W = point_W - after_[link].X_WL * points_[link];
    const Eigen::Vector3d turning_W = now.angular_W.cross(arm_W);
    Eigen::Vector3d sum_W = linear_W + angular_W.cross(arm_W) + now.angular_W.cross(turning_W);
    if (has_parent) sum_W += 2.0 * after_[parents_[link]].twist.angular_W.cross(now.linear_W + turning_W);
    return sum_W;
  }

  // By link: its parent, and the point of the link whose velocity relative to the parent is recorded. This is the
  // origin of the joint, or the reference point of a free root.
  std::vector<std::size_t> parents_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<char> is_free_;
  std::vector<LinkMotion> before_;
  std::vector<LinkMotion> after_;
  bool is_whole_ = false;
};

}  // namespace cohort::physics
