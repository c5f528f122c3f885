#pragma once

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Puts a plane into a world that has nothing but one model, and the model onto it, its lowest point just above the
/// plane at z = 0. A model that is ground itself, or has nothing solid, stays where it is; of what then falls for ever
/// a warning tells.
void stand_on_plane(World& world);

}  // namespace cohort::parsing
