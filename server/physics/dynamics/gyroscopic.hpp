#pragma once

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Returns whether a part of a body spins so fast while it is turned, or turns so fast on a ball joint, that explicit
/// gyroscopic torques would be unstable. Evaluated at the beginning of each `step` [s], they would add or remove energy
/// without bound. For a body that is held, friction removes more energy than slow rotation adds.
bool has_stiff_gyroscopic_torques(const BodyMotion& body, double step, bool is_held);

}  // namespace cohort::physics
