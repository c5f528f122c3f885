// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/description/world.hpp"
#include "server/placement/placement.hpp"

namespace cohort::placement {

/// Checks the children of the detachable joints of models, in a world whose objects are complete. Adds a warning to the
/// world for a missing child, and a problem for a child that cannot be held. Each is reported once, for any number of
/// instances of the model.
void check_detachable_joints(World& world, std::vector<Problem>& problems);

}  // namespace cohort::placement
