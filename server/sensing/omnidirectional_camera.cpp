#include <algorithm>
#include <numbers>

#include "server/sensing/markers_in_sight.hpp"
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Coloured spots all round (description::OmnidirectionalCamera), as `markers_in_sight` finds them: what the s-bot's
/// camera makes of its image in the end.
class OmnidirectionalCamera final : public Sensor {
 public:
  OmnidirectionalCamera(const description::OmnidirectionalCamera& camera, const Mount& mount)
      : camera_(camera), mount_(mount) {}
  std::vector<Channel> channels() const override {
    constexpr double pi = std::numbers::pi;
    const auto most = static_cast<double>(camera_.capacity);
    std::vector<Channel> channels{{camera_.name + "/0/count", "1", 1, 0.0, most, 0.0, false}};
    for (std::size_t i = 0; i < camera_.capacity; ++i) {
      const std::string name = camera_.name + "/" + std::to_string(i);
      channels.push_back({name + "/bearing", "rad", 1, -pi, pi, 0.0});
      channels.push_back({name + "/elevation", "rad", 1, -pi / 2.0, pi / 2.0, 0.0});
      channels.push_back({name + "/distance", "m", 1, 0.0, camera_.range, 0.0});
      channels.push_back({name + "/color", "1", 3, 0.0, 1.0, 0.0, false});
    }
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    std::ranges::fill(values, 0.0);
    const Pose X_WS = pose_of(camera_, mount_);
    const std::vector<Spot> spots =
        markers_in_sight(mount_, X_WS, {camera_.range, camera_.min_elevation, camera_.max_elevation, camera_.capacity});
    std::size_t i = 0;
    values[i++] = static_cast<double>(spots.size());
    for (const Spot& spot : spots) {
      values[i++] = spot.bearing;
      values[i++] = spot.elevation;
      values[i++] = spot.distance;
      for (const double part : mount_.emitters.marker(spot.marker).color) values[i++] = part;
    }
  }

 private:
  description::OmnidirectionalCamera camera_;
  Mount mount_;
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::OmnidirectionalCamera& camera, const Mount& mount) {
  return std::make_unique<OmnidirectionalCamera>(camera, mount);
}

}  // namespace cohort::sensing
