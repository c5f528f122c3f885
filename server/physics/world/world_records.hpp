#pragma once

#include <Eigen/Core>

#include "server/core/ids.hpp"
#include "server/physics/world/world_connections.hpp"

namespace cohort::physics {

/// What sensors measure of forces and accelerations. A world keeps it only for the bodies that it was told to record.
class WorldRecords {
 public:
  /// Keeps, from the next step on, what `joint_wrench` and `link_acceleration` tell of a body that moves, which are
  /// zero otherwise. Called between steps. None of the three is part of the state: after `restore`, and where a body
  /// was put elsewhere or is not in the world, both are zero until the end of the next step. A static body has neither.
  virtual void record(BodyId body) = 0;
  /// Returns the wrench on the joint's child by its parent over the last step, about the joint's origin, both as they
  /// were when the step began: all that goes through the joint, of motor, friction, damping, spring, limits and what
  /// the joint does not let move; also of a fixed joint. Zero for a planar body.
  virtual Wrench joint_wrench(BodyId body, JointId joint) const = 0;
  /// Returns the mean acceleration over the last step of a point that is fixed to a link, in world axes, gravity not
  /// taken out [m/s^2]: zero at rest, `gravity` in free fall.
  virtual Eigen::Vector3d link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const = 0;

 protected:
  ~WorldRecords() = default;
};

}  // namespace cohort::physics
