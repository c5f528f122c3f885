#include "server/sensing/proximity_ring.hpp"

#include <cmath>

#include "server/geometry/ray_fan.hpp"

namespace cohort::sensing {

ProximityRing::ProximityRing(const description::ProximityRing& ring, Mount mount)
    : ring_(ring), mount_(std::move(mount)) {
  for (std::size_t i = 0; i < ring.count; ++i) {
    const double bearing = ring.first_bearing + static_cast<double>(i) * ring.spacing;
    directions_S_.emplace_back(std::cos(bearing), std::sin(bearing), 0.0);
  }
}

std::vector<Channel> ProximityRing::channels() const {
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < ring_.count; ++i)
    channels.push_back({ring_.name + "/" + std::to_string(i) + "/reading", "1", 1, 0.0, 1.0, 0.0});
  return channels;
}

void ProximityRing::sense(std::uint64_t, std::span<double> values) const {
  const Pose X_WS = mount_.world.link_pose(mount_.body, ring_.link) * ring_.X_LS;
  const geometry::Bounds disc = geometry::bounds_of_disc(X_WS, ring_.ring_radius + ring_.range);
  const geometry::RayFan fan(mount_.world.scene(), X_WS.position, disc, mount_.body);
  for (std::size_t i = 0; i < ring_.count; ++i) {
    const Eigen::Vector3d direction_W = X_WS.orientation * directions_S_[i];
    const Eigen::Vector3d origin_W = X_WS.position + ring_.ring_radius * direction_W;
    const auto hit = fan.cast(origin_W, direction_W, ring_.range);
    values[i] = hit ? 1.0 - hit->distance / ring_.range : 0.0;
  }
}

}  // namespace cohort::sensing
