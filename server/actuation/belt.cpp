// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Surface velocity of a link [m/s].
class Belt final : public ActuatorOf<description::Belt> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/velocity", "m/s", 1, -device_.max_velocity, device_.max_velocity, device_.velocity}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_device_target(mount_.body, mount_.device, 0, values[0]);
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::Belt& belt, const Mount& mount) {
  return std::make_unique<Belt>(belt, mount);
}

}  // namespace cohort::actuation
