// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Distance and velocity of both tracks of a treel drive, exact. A slipping track counts its own motion, like an
/// encoder on its motor.
class TreelEncoder final : public SensorOf<description::TreelEncoder> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    for (const char* side : {"/left", "/right"}) {
      channels.push_back({device_.name + side + "/position", "m", 1, -infinity, infinity, 0.0});
      channels.push_back({device_.name + side + "/velocity", "m/s", 1, -infinity, infinity, 0.0});
    }
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    std::size_t i = 0;
    for (const std::size_t side : {0, 1}) {
      const physics::OutputState track = mount_.world.device_state(mount_.body, DeviceId{device_.drive}, side);
      values[i++] = track.position;
      values[i++] = track.velocity;
    }
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::TreelEncoder& encoder, const Mount& mount) {
  return std::make_unique<TreelEncoder>(encoder, mount);
}

}  // namespace cohort::sensing
