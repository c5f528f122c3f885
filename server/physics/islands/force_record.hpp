#pragma once

#include <cstdint>
#include <vector>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/world/motion_record.hpp"

namespace cohort::physics {

/// What went through the joints of one body in its last step: inverse dynamics of each link, also of links that are
/// welded into one segment (recursive Newton-Euler; Featherstone, "Rigid body dynamics algorithms", 2008, chapter 5).
///
/// It takes the accelerations that the step found, at the place and the velocities where the step began, or at those of
/// its middle where the equations do (Equations::is_symmetric): these are the equations that the solver solved, so what
/// goes through a joint along its axis is what its motor, friction, damping, spring and limits gave, to the last
/// digits. Kept for those bodies alone of which somebody asked for it, and no part of the state.
class ForceRecord {
 public:
  /// `links_of_solids`: of the body's solids in their order, of which `first_solid` is the first.
  ForceRecord(const Mechanism& mechanism, std::uint32_t first_solid, std::vector<std::size_t> links_of_solids);

  /// Call these two around the integration of a step.
  void begin(const BodyMotion& body);
  /// `velocities`: those that the solver found; `in_the_middle`: with bias forces of the middle of the step.
  void finish(const BodyMotion& body, const double* velocities, bool in_the_middle, const Eigen::Vector3d& gravity,
              double step);
  /// What acted from outside on a link during the step that was finished, as an impulse at a point and an angular
  /// impulse [N s, N m s]; nothing if there is no such step.
  void add_outside(std::size_t link, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W,
                   const Eigen::Vector3d& angular_impulse_W);
  /// The last step is no longer known.
  void forget() { motion_.forget(); }

  std::size_t link_of(std::uint32_t solid) const { return links_of_solids_[solid - first_solid_]; }
  const MotionRecord& motion() const { return motion_; }
  /// On the joint's child by its parent, about the joint's origin where the step began; zero if the last step is not
  /// known.
  Wrench joint_wrench(std::size_t index) const;

 private:
  struct SegmentMotion {
    Eigen::Vector3d angular_velocity_W;
    Eigen::Vector3d angular_acceleration_W;
    Eigen::Vector3d acceleration_W;  // of the segment's origin
  };
  void add_needed(double factor, const std::vector<double>& velocities, const std::vector<double>& accelerations,
                  const Eigen::Vector3d& gravity);
  void find_accelerations(const std::vector<double>& velocities, const std::vector<double>& accelerations);

  const Mechanism& mechanism_;
  std::uint32_t first_solid_;
  std::vector<std::size_t> links_of_solids_;
  std::vector<std::size_t> parents_;  // of each link, itself for the root
  MotionRecord motion_;
  double step_ = 0.0;
  // Where the step began:
  std::vector<Pose> X_WS_;
  std::vector<double> velocities_;
  Eigen::Vector3d reference_W_ = Eigen::Vector3d::Zero();
  // By segment, and what each link needs beside what acts on it from outside, about the reference:
  std::vector<SegmentMotion> segments_;
  std::vector<Wrench> needed_;
};

}  // namespace cohort::physics
