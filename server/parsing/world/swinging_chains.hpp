// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Adds a warning for each model with a chain of links that swings too fast for the step size of the world. Only joints
/// without motors, damping, friction, springs and couplings count. Such a chain may gain energy without bound.
void warn_of_swinging_chains(World& world);

}  // namespace cohort::parsing
