#pragma once

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Of a velocity or an acceleration; of a force: the torque and the force.
struct Spatial {
  Eigen::Vector3d angular;
  Eigen::Vector3d linear;
};

/// By dof, the velocity that a unit of it gives to all that hangs on it, about the body's reference point in world
/// axes.
void find_joint_axes(const BodyMotion& body, std::vector<Spatial>& axes);

}  // namespace cohort::physics
