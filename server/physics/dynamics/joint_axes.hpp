#pragma once

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Computes, by dof, the velocity that a unit rate gives to everything it carries, about the body's reference point in
/// world axes.
void find_joint_axes(const BodyMotion& body, std::vector<Spatial>& axes);

}  // namespace cohort::physics
