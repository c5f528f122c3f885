// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Height of the origin of S relative to its initial height, and its upward velocity, both along the world's z axis.
/// The initial height is that at construction: before the first step of a run, also if the run is then restored.
class Altimeter final : public SensorOf<description::Altimeter> {
 public:
  Altimeter(const description::Altimeter& altimeter, const Mount& mount)
      : SensorOf(altimeter, mount), first_height_(pose_of(altimeter, mount).position.z()) {}
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/vertical_position", "m", 1, -infinity, infinity, 0.0},
            {device_.name + "/0/vertical_velocity", "m/s", 1, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    values[0] = pose_of(device_, mount_).position.z() - first_height_;
    values[1] = velocity_of(device_, mount_).z();
  }

 private:
  double first_height_;  // [m]
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Altimeter& altimeter, const Mount& mount) {
  return std::make_unique<Altimeter>(altimeter, mount);
}

}  // namespace cohort::sensing
