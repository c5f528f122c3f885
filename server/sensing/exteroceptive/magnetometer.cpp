// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// The world's uniform magnetic field, in S.
class Magnetometer final : public SensorOf<description::Magnetometer> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/magnetic_field", "T", 3, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    write(Eigen::Vector3d(pose_of(device_, mount_).orientation.conjugate() * mount_.description.magnetic_field),
          values);
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Magnetometer& sensor, const Mount& mount) {
  return std::make_unique<Magnetometer>(sensor, mount);
}

}  // namespace cohort::sensing
