#pragma once

#include <Eigen/Core>

#include "server/core/ids.hpp"
#include "server/physics/world/world_connections.hpp"

namespace cohort::physics {

/// Forces and accelerations that sensors measure. A world keeps them only for recorded bodies.
class WorldRecords {
 public:
  /// Records `joint_wrench` and `link_acceleration` of a moving body from the next step on; they are zero otherwise.
  /// Called between steps. Nothing of this is part of the state. After `restore`, and for a body that was placed
  /// elsewhere or is not in the world, both are zero until the end of the next step. A static body has neither.
  virtual void record(BodyId body) = 0;
  /// Returns the wrench on the joint's child by its parent over the last step, about the joint's origin, both as they
  /// were at the beginning of the step. It is the total of motor, friction, damping, spring, limits and constraint
  /// forces, also for a fixed joint. Zero for a planar body.
  virtual Wrench joint_wrench(BodyId body, JointId joint) const = 0;
  /// Returns the mean acceleration over the last step of a point fixed to a link, in world axes [m/s^2]. It includes
  /// gravity: zero at rest, `gravity` in free fall.
  virtual Eigen::Vector3d link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const = 0;

 protected:
  ~WorldRecords() = default;
};

}  // namespace cohort::physics
