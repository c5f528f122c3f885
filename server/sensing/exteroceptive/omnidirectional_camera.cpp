// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>

#include "server/sensing/exteroceptive/markers_in_sight.hpp"
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Coloured spots in all directions (description::OmnidirectionalCamera), as found by `markers_in_sight`: the processed
/// image of the s-bot's camera.
class OmnidirectionalCamera final : public SensorOf<description::OmnidirectionalCamera> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    constexpr double pi = std::numbers::pi;
    const auto most = static_cast<double>(device_.capacity);
    std::vector<Channel> channels{{device_.name + "/0/count", "1", 1, 0.0, most, 0.0, false}};
    for (std::size_t i = 0; i < device_.capacity; ++i) {
      const std::string name = device_.name + "/" + std::to_string(i);
      channels.push_back({name + "/bearing", "rad", 1, -pi, pi, 0.0});
      channels.push_back({name + "/elevation", "rad", 1, -pi / 2.0, pi / 2.0, 0.0});
      channels.push_back({name + "/distance", "m", 1, 0.0, device_.range, 0.0});
      channels.push_back({name + "/color", "1", 3, 0.0, 1.0, 0.0, false});
    }
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    std::ranges::fill(values, 0.0);
    const Pose X_WS = pose_of(device_, mount_);
    const std::vector<Spot> spots =
        markers_in_sight(mount_, X_WS, {device_.range, device_.min_elevation, device_.max_elevation, device_.capacity});
    std::size_t i = 0;
    values[i++] = static_cast<double>(spots.size());
    for (const Spot& spot : spots) {
      values[i++] = spot.bearing;
      values[i++] = spot.elevation;
      values[i++] = spot.distance;
      for (const double part : mount_.emitters.marker(spot.marker).color) values[i++] = part;
    }
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::OmnidirectionalCamera& camera, const Mount& mount) {
  return std::make_unique<OmnidirectionalCamera>(camera, mount);
}

}  // namespace cohort::sensing
