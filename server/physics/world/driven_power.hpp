#pragma once

#include "server/description/model.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// Returns the mechanical power that the devices of a body, an instance of `model`, delivered over the last step [W].
/// It sums joints and all outputs, each at its velocity at the end of the step; one that brakes counts as 0.
double driven_power(const World& world, BodyId body, const description::Model& model);

}  // namespace cohort::physics
