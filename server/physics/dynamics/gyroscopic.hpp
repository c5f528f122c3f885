#pragma once

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Whether something in a body spins so fast while it is turned, or turns on a ball joint, that torques which a step
/// [s] takes as they are at its beginning would give it energy without end, or take it. Of what is held, friction
/// takes more than slow turning gives.
bool has_stiff_gyroscopic_torques(const BodyMotion& body, double step, bool is_held);

}  // namespace cohort::physics
