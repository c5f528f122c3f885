// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Infrared sensors under a robot, each a ray along -z of the link. The reading is 1 - d / range for a surface at
/// distance d, and 0 if there is none within range, as over a hole (thesis, section 3.2.2).
class GroundSensors final : public SensorOf<description::GroundSensors> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < device_.places_L.size(); ++i)
      channels.push_back({device_.name + "/" + std::to_string(i) + "/reading", "1", 1, 0.0, 1.0, 0.0});
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Pose X_WL = mount_.world.link_pose(mount_.body, LinkId{device_.link});
    const Eigen::Vector3d down_W = X_WL.orientation * -Eigen::Vector3d::UnitZ();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto hit = mount_.world.scene().cast_ray(X_WL * device_.places_L[i], down_W, device_.range, mount_.body);
      values[i] = hit ? 1.0 - hit->distance / device_.range : 0.0;
    }
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::GroundSensors& sensors, const Mount& mount) {
  return std::make_unique<GroundSensors>(sensors, mount);
}

}  // namespace cohort::sensing
