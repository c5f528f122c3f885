#pragma once

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Adds a warning for each model with a chain of links, on joints that nothing brakes, which swings too fast for the
/// world's steps. Such a chain may gain energy without bound.
void warn_of_swinging_chains(World& world);

}  // namespace cohort::parsing
