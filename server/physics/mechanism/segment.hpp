// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "server/core/pose.hpp"
#include "server/physics/mechanism/spatial_inertia.hpp"

namespace cohort::physics {

/// The motion of a segment relative to its parent. `free`: six dofs; `anchored`: fixed to the world. A new
/// kind of motion needs the functions of this header and the set-up of Bullet's bodies.
enum class Motion { free, anchored, revolute, prismatic, ball };

/// Links that are welded together and move as one. Frame S has its origin at the joint above, or at the root link, and
/// the principal axes of the segment's mass.
struct Segment {
  int parent = -1;  ///< -1: none; `X_PS` is then in the model's frame
  Motion motion = Motion::free;
  Pose X_PS;  ///< with all coordinates at zero
  /// Rotation from the frame of the joint above, or of the root link, to S.
  Eigen::Quaterniond principal_axes = Eigen::Quaterniond::Identity();
  Eigen::Vector3d axis_S;  ///< for a revolute or prismatic joint
  int first_dof = 0;
  int dofs = 0;
  int first_coordinate = 0;
  int last_dof = -1;  ///< its own, or that of the nearest segment above that has one; -1: immovable

  double mass = 0.0;                                    ///< may be zero: the middle of a universal joint
  Eigen::Vector3d centre_S = Eigen::Vector3d::Zero();   ///< centre of mass
  Eigen::Matrix3d inertia_S = Eigen::Matrix3d::Zero();  ///< about the centre of mass, diagonal
};

int dofs_of(Motion motion);

/// Returns the coordinates of a joint at zero: none, an angle, a displacement, or a quaternion x y z w.
std::span<const double> zero_coordinates_of(Motion motion);

/// Returns the number of rotational dofs. They come before the translational ones.
int turning_dofs_of(Motion motion);

/// Returns the pose of a segment that a joint holds; `X_WS` is its pose with `coordinates` at zero.
Pose moved_by_joint(const Segment& segment, const Pose& X_WS, const double* coordinates);

/// Advances the coordinates of a joint by a step [s] with the velocities `v`. A free root has none.
void move_joint(const Segment& segment, const double* v, double step, double* coordinates);

/// Returns the motion relative to the parent per unit of the segment's dof `i`, in world axes: about the segment's
/// origin, or about the reference point of a free root.
inline Spatial axis_of_joint(const Segment& segment, const Eigen::Matrix3d& R_WS, int i) {
  Spatial axis{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  switch (segment.motion) {
    case Motion::anchored: break;
    case Motion::free: (i < 3 ? axis.angular : axis.linear)[i % 3] = 1.0; break;
    case Motion::revolute: axis.angular = R_WS * segment.axis_S; break;
    case Motion::prismatic: axis.linear = R_WS * segment.axis_S; break;
    case Motion::ball: axis.angular = R_WS.col(i); break;
  }
  return axis;
}

/// Returns the spatial velocity relative to the parent for the velocities `v` of the segment's dofs, about the point of
/// `axis_of_joint`. For other rates of the dofs, such as velocity changes, it returns the corresponding spatial vector.
/// `R_WS` is a matrix or a quaternion.
template <class Rotation>
Spatial motion_at_joint(const Segment& segment, const Rotation& R_WS, const double* v) {
  Spatial motion{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  switch (segment.motion) {
    case Motion::anchored: break;
    case Motion::free: motion = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}; break;
    case Motion::revolute: motion.angular = v[0] * (R_WS * segment.axis_S); break;
    case Motion::prismatic: motion.linear = v[0] * (R_WS * segment.axis_S); break;
    case Motion::ball: motion.angular = R_WS * Eigen::Vector3d(v[0], v[1], v[2]); break;
  }
  return motion;
}

}  // namespace cohort::physics
