// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Position and velocity of the origin of S, in the axes of the world, which is flat: its x axis points east, its y
/// axis north.
class NavSat final : public SensorOf<description::NavSat> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/position", "m", 3, -infinity, infinity, 0.0},
            {device_.name + "/0/velocity", "m/s", 3, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    write(pose_of(device_, mount_).position, values.first(3));
    write(velocity_of(device_, mount_), values.subspan(3));
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::NavSat& sensor, const Mount& mount) {
  return std::make_unique<NavSat>(sensor, mount);
}

}  // namespace cohort::sensing
