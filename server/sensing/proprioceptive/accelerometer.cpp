// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Proper acceleration along the axes of S: the acceleration of its origin at the end of the last step, minus gravity.
/// At rest it is g upwards, in free fall 0.
class Accelerometer final : public SensorOf<description::Accelerometer> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/acceleration", "m/s^2", 3, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    write(proper_acceleration_of(device_, mount_), values);
  }
  bool needs_record() const override { return true; }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Accelerometer& sensor, const Mount& mount) {
  return std::make_unique<Accelerometer>(sensor, mount);
}

}  // namespace cohort::sensing
