// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/exteroceptive/markers_in_sight.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::sensing {

std::vector<Spot> markers_in_sight(const Mount& mount, const Pose& X_WS, const FieldOfView& view) {
  constexpr double clearance = 2e-3;  // [m]
  std::vector<Spot> spots;
  mount.emitters.for_each_marker_near(X_WS.position, view.range, [&](std::uint32_t index) {
    const emission::Marker& marker = mount.emitters.marker(index);
    if (marker.mount.body == mount.body) return;
    const Eigen::Vector3d p_S = X_WS.orientation.conjugate() * (marker.p_W - X_WS.position);
    const double distance = p_S.norm();
    if (distance > view.range) return;
    const double elevation = std::atan2(p_S.z(), std::sqrt(p_S.x() * p_S.x() + p_S.y() * p_S.y()));
    if (elevation < view.min_elevation || elevation > view.max_elevation) return;
    spots.push_back({distance, std::atan2(p_S.y(), p_S.x()), elevation, index});
  });
  std::sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.marker < b.marker;
  });
  std::size_t seen = 0;
  for (const Spot& spot : spots) {
    if (seen == view.most) break;
    const double reach = spot.distance - clearance;
    const Eigen::Vector3d direction_W = (mount.emitters.marker(spot.marker).p_W - X_WS.position) / spot.distance;
    if (reach > 0.0 && !mount.world.scene().is_free(X_WS.position, direction_W, reach, mount.body)) continue;
    spots[seen++] = spot;
  }
  spots.resize(seen);
  return spots;
}

}  // namespace cohort::sensing
