// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Adds a warning for each robot, and each other model with joints, that is so large that its sizes are probably in
/// millimetres.
void warn_of_sizes(World& world);

}  // namespace cohort::parsing
