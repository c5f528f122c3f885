// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "server/core/ids.hpp"
#include "server/physics/world/world_connections.hpp"

namespace cohort::physics {

/// Forces and accelerations that sensors measure. A world keeps them only for recorded bodies.
class WorldRecords {
 public:
  /// Records the following values of a moving body from the next step on; they are zero otherwise. Called between
  /// steps. Nothing of this is part of the state. After `restore`, and for a body that was placed elsewhere or is not
  /// in the world, all are zero until the end of the next step. A static body has none.
  virtual void record(BodyId body) = 0;
  /// Returns the wrench on the joint's child by its parent over the last step, about the joint's origin. It is the
  /// total of motor, friction, damping, spring, limits and constraint forces, also for a fixed joint. Zero for a planar
  /// body.
  ///
  /// The solver finds it for the poses at the beginning of the step, and it is returned as if it had turned with the
  /// child. In the axes of the child, it is therefore the same at the beginning and at the end of the step.
  virtual Wrench joint_wrench(BodyId body, JointId joint) const = 0;
  /// Returns the wrench on the joint's parent by its child, like `joint_wrench`, but it has turned with the parent: it
  /// is the same in the axes of the parent. The two are opposite, except for the rotation of the joint in the step.
  virtual Wrench joint_wrench_on_parent(BodyId body, JointId joint) const = 0;
  /// Returns the acceleration of a point fixed to a link at the end of the last step, in world axes [m/s^2]. Rates of
  /// change of velocities relative to the parent link are means over the step. It includes gravity: zero at rest,
  /// `gravity` in free fall.
  virtual Eigen::Vector3d link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const = 0;

 protected:
  ~WorldRecords() = default;
};

}  // namespace cohort::physics
