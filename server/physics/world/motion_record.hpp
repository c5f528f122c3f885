#pragma once

#include <cstddef>
#include <vector>

#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// The motion of the links of one body over its last step. Kept only for bodies for which it was requested, and not
/// part of the state.
class MotionRecord {
 public:
  /// Records the motion; call `before` and `after` around the integration of a step. `Body` has link_pose and
  /// link_twist of a link.
  template <class Body>
  void before(const Body& body, std::size_t links) {
    keep(before_, body, links);
    is_whole_ = false;
  }
  template <class Body>
  void after(const Body& body, std::size_t links) {
    keep(after_, body, links);
    is_whole_ = true;
  }
  /// Forgets the last step: the body was placed elsewhere or did not take part in it.
  void forget() { is_whole_ = false; }
  bool is_whole() const { return is_whole_; }

  const Pose& pose_before(std::size_t link) const { return before_[link].X_WL; }
  /// Returns the mean acceleration over the step of a point fixed to the link, in world axes [m/s^2]; zero if the last
  /// step is not known.
  Eigen::Vector3d acceleration(std::size_t link, const Eigen::Vector3d& p_LP, double step) const {
    if (!is_whole_) return Eigen::Vector3d::Zero();
    return (velocity(after_[link], p_LP) - velocity(before_[link], p_LP)) / step;
  }

 private:
  struct LinkMotion {
    Pose X_WL;
    Twist twist;
  };

  template <class Body>
  static void keep(std::vector<LinkMotion>& motions, const Body& body, std::size_t links) {
    motions.resize(links);
    for (std::size_t link = 0; link < links; ++link) motions[link] = {body.link_pose(link), body.link_twist(link)};
  }
  static Eigen::Vector3d velocity(const LinkMotion& motion, const Eigen::Vector3d& p_LP) {
    return motion.twist.linear_W + motion.twist.angular_W.cross(motion.X_WL.orientation * p_LP);
  }

  std::vector<LinkMotion> before_;
  std::vector<LinkMotion> after_;
  bool is_whole_ = false;
};

}  // namespace cohort::physics
