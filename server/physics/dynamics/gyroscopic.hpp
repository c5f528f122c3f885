// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/dynamics/mass_matrix.hpp"

namespace cohort::physics {

/// A function that returns the factorised mass matrix of a body.
using FactorisedMass = std::function<const MassMatrix&()>;

/// Returns whether a part of a body spins so fast while it is turned, or turns so fast on a joint, that explicit
/// gyroscopic and centrifugal forces would be unstable. Evaluated at the beginning of each `step` [s], they would add
/// or remove energy without bound. The limit is higher for a body that is held, since friction hides the error there.
/// `mass` is called only for some bodies that turn fast.
bool has_stiff_gyroscopic_torques(const BodyMotion& body, double step, bool is_held, const FactorisedMass& mass);

}  // namespace cohort::physics
