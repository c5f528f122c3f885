// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/simulation/simulation.hpp"

namespace cohort::viewing {

/// A pinhole camera. It looks from `position_W` at `target_W`, with z up.
struct PictureCamera {
  Eigen::Vector3d position_W;
  Eigen::Vector3d target_W;
  double vertical_field_of_view = 0.8;  ///< [rad]
};

/// Returns a camera that shows all bounded static solids, and the robots at the poses of the description. It depends on
/// the description alone, so it is the same in the whole run. `aspect`: width over height.
PictureCamera camera_for(const Simulation& simulation, double aspect);

/// Draws the collision shapes of a world with the colours of their links, one ray for each pixel, without shadows.
/// Returns [row, column, 3]: red, green, blue. Throws std::invalid_argument if a size is not from 1 to 4096, or if the
/// camera's numbers are not finite or its position is its target. Only reads, on the calling thread.
std::vector<std::uint8_t> draw_picture(const Simulation& simulation, const PictureCamera& camera, int width,
                                       int height);

}  // namespace cohort::viewing
