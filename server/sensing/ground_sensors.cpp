#include "server/sensing/ground_sensors.hpp"

namespace cohort::sensing {

std::vector<Channel> GroundSensors::channels() const {
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < sensors_.places_L.size(); ++i)
    channels.push_back({sensors_.name + "/" + std::to_string(i) + "/reading", "1", 1, 0.0, 1.0, 0.0});
  return channels;
}

void GroundSensors::sense(std::uint64_t, std::span<double> values) const {
  const Pose X_WL = mount_.world.link_pose(mount_.body, sensors_.link);
  const Eigen::Vector3d down_W = X_WL.orientation * -Eigen::Vector3d::UnitZ();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto hit = mount_.world.scene().cast_ray(X_WL * sensors_.places_L[i], down_W, sensors_.range, mount_.body);
    values[i] = hit ? 1.0 - hit->distance / sensors_.range : 0.0;
  }
}

}  // namespace cohort::sensing
