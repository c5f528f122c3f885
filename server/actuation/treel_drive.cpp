// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Velocities of the left and the right track over ground [m/s].
class TreelDrive final : public ActuatorOf<description::TreelDrive> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    for (const char* side : {"/left", "/right"})
      channels.push_back(
          {device_.name + side + "/velocity", "m/s", 1, -device_.max_velocity, device_.max_velocity, 0.0});
    return channels;
  }
  void apply(std::span<const double> values) override {
    for (std::size_t side = 0; side < 2; ++side)
      mount_.world.set_device_target(mount_.body, mount_.device, side, values[side]);
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::TreelDrive& drive, const Mount& mount) {
  return std::make_unique<TreelDrive>(drive, mount);
}

}  // namespace cohort::actuation
