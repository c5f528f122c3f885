// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Adds a warning if one movable model is so much heavier than another one that contacts between them are inaccurate.
void warn_of_mass_ratio(World& world);

}  // namespace cohort::parsing
