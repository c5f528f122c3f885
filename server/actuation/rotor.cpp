// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Velocity of a propeller [rad/s].
class Rotor final : public ActuatorOf<description::Rotor> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/velocity", "rad/s", 1, device_.min_velocity, device_.max_velocity, 0.0}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_device_target(mount_.body, mount_.device, 0, values[0]);
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::Rotor& rotor, const Mount& mount) {
  return std::make_unique<Rotor>(rotor, mount);
}

}  // namespace cohort::actuation
