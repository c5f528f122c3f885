#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// A coloured spot as a camera sees it.
struct Spot {
  double distance = 0.0;   ///< [m]
  double bearing = 0.0;    ///< in the camera's frame, from its x axis [rad]
  double elevation = 0.0;  ///< from its xy plane [rad]
  std::uint32_t marker = 0;
};

/// What a camera looks for.
struct FieldOfView {
  double range = 0.0;          ///< [m], may be infinite
  double min_elevation = 0.0;  ///< [rad]
  double max_elevation = 0.0;
  std::size_t most = 0;  ///< spots
};

/// The nearest of the lit markers that are in the field of view of a camera at X_WS and in sight, nearest first, of two
/// at the same distance the one with the lower index. A marker is in sight if a ray to it, which ends 2 mm before it,
/// meets nothing but the camera's own body. So the body that carries a marker hides it on its far side, and inside; on
/// the near side that body may come up to 2 mm before it. Markers of the camera's own body are left out.
std::vector<Spot> markers_in_sight(const Mount& mount, const Pose& X_WS, const FieldOfView& view);

}  // namespace cohort::sensing
