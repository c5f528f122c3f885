// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/model.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// Returns the mechanical power that the devices of a body, an instance of `model`, delivered over the last step [W].
/// It is the sum of effort times velocity at the end of the step over all motors and outputs, without those that brake.
double driven_power(const World& world, BodyId body, const description::Model& model);

}  // namespace cohort::physics
