#pragma once

#include <vector>

#include "server/description/world.hpp"
#include "server/placement/placement.hpp"

namespace cohort::placement {

/// What detachable joints of models hold, in a world whose objects are all there: one that is not there is in a warning
/// of the world, what cannot be held among the problems. Each is said once, however many instances the model has.
void check_detachable_joints(World& world, std::vector<Problem>& problems);

}  // namespace cohort::placement
