// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/shape.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Maximum number of heights of a terrain along x or y.
inline constexpr double most_terrain_heights = 4097;

/// Returns the heights of a terrain, which are identical on every machine. Throws std::runtime_error if there are more
/// than `most_terrain_heights` along a side.
HeightGrid terrain_heights(const Terrain& terrain);

}  // namespace cohort::parsing
