// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/world/motion_record.hpp"

namespace cohort::physics {

/// The forces and torques through the joints of one body in its last step. Computed by inverse dynamics of each link,
/// also of links that are welded into one segment (recursive Newton-Euler; Featherstone, "Rigid body dynamics
/// algorithms", 2008, chapter 5).
///
/// It uses the accelerations over the step, at the poses and velocities at its beginning. If the equations use the
/// velocities at the middle of the step (Equations::is_symmetric), so does this. These are the equations that the
/// solver solved. The component along a joint's axis is therefore the sum of its motor, friction, damping, spring and
/// limit efforts, except for rounding. Kept only for bodies for which it was requested, and not part of the state.
class ForceRecord {
 public:
  /// `links_of_solids`: the link of each of the body's solids, starting with solid `first_solid`.
  ForceRecord(const Mechanism& mechanism, std::uint32_t first_solid, std::vector<std::size_t> links_of_solids);

  /// Call `begin` before and `finish` after the integration of a step.
  void begin(const BodyMotion& body);
  /// `velocities`: those that the solver found. `in_the_middle`: bias forces are those of the middle of the step.
  void finish(const BodyMotion& body, const double* velocities, bool in_the_middle, const Eigen::Vector3d& gravity,
              double step);
  /// Adds an external impulse at a point and an angular impulse [N s, N m s] on a link during the finished step. Does
  /// nothing if there is no such step.
  void add_outside(std::size_t link, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
                   const Eigen::Vector3d& angular_impulse_W);
  /// Forgets the last step.
  void forget() { motion_.forget(); }

  std::size_t link_of(std::uint32_t solid) const { return links_of_solids_[solid - first_solid_]; }
  const MotionRecord& motion() const { return motion_; }
  /// Returns the wrench on the joint's child by its parent, about the joint's origin. It is that of the beginning of
  /// the step, turned with the child; zero if the last step is not known.
  Wrench joint_wrench(std::size_t index) const;
  /// Returns the wrench on the joint's parent by its child, turned with the parent.
  Wrench joint_wrench_on_parent(std::size_t index) const;

 private:
  struct SegmentMotion {
    Eigen::Vector3d angular_velocity_W;
    Eigen::Vector3d angular_acceleration_W;
    Eigen::Vector3d velocity_W;      // at the segment's origin
    Eigen::Vector3d acceleration_W;  // likewise
  };
  void add_needed(double factor, const std::vector<double>& velocities, const std::vector<double>& accelerations,
                  const Eigen::Vector3d& gravity);
  void add_needed_in_fluid(double factor, std::size_t link, const SpatialMatrix& added_mass);
  Wrench wrench_before(const description::Joint& joint) const;
  void find_accelerations(const std::vector<double>& velocities, const std::vector<double>& accelerations);

  const Mechanism& mechanism_;
  std::uint32_t first_solid_;
  std::vector<std::size_t> links_of_solids_;
  std::vector<std::size_t> parents_;  // by link; the root is its own parent
  MotionRecord motion_;
  double step_ = 0.0;
  // At the beginning of the step:
  std::vector<Pose> X_WS_;
  std::vector<double> velocities_;
  Eigen::Vector3d reference_W_ = Eigen::Vector3d::Zero();
  // Motion by segment, and the wrench by link that is needed in addition to the external ones, about the reference
  // point:
  std::vector<SegmentMotion> segments_;
  std::vector<Wrench> needed_;
};

}  // namespace cohort::physics
