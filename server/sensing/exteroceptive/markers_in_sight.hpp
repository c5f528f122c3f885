// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// A coloured spot that a camera sees.
struct Spot {
  double distance = 0.0;   ///< [m]
  double bearing = 0.0;    ///< from the x axis of the camera's frame [rad]
  double elevation = 0.0;  ///< from the xy plane of the camera's frame [rad]
  std::uint32_t marker = 0;
};

/// The limits of a camera's view.
struct FieldOfView {
  double range = 0.0;          ///< [m], may be infinite
  double min_elevation = 0.0;  ///< [rad]
  double max_elevation = 0.0;
  std::size_t most = 0;  ///< maximum number of spots
};

/// Returns the nearest lit and visible markers in the field of view of a camera at X_WS, nearest first. If two have the
/// same distance, the one with the lower index comes first. A marker is visible if a ray to it, which ends 2 mm before
/// it, hits nothing but the camera's own body. So the body that carries a marker hides it on its far side and inside;
/// on the near side that body may extend up to 2 mm before it. Markers of the camera's own body are left out.
std::vector<Spot> markers_in_sight(const Mount& mount, const Pose& X_WS, const FieldOfView& view);

}  // namespace cohort::sensing
