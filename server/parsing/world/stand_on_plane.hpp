// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Adds a plane to a world with a single model, and places the model on it, with its lowest point just above the plane
/// at z = 0. A model that is ground itself, or has nothing solid, is not moved. Adds a warning for a model that would
/// fall without end.
void stand_on_plane(World& world);

}  // namespace cohort::parsing
