// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Computes the motion axis of each dof: the spatial velocity that a unit rate of the dof gives to the segments beyond
/// it. Axes are about the body's reference point, in world axes.
void find_joint_axes(const BodyMotion& body, std::vector<Spatial>& axes);

}  // namespace cohort::physics
