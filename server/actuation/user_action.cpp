// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// An action of a robot, signalled by a value from 0 to 1.
class UserAction final : public ActuatorOf<description::UserAction> {
 public:
  UserAction(const description::UserAction& action, const Mount& mount)
      : ActuatorOf(action, mount), number_(mount.actions.of_device(mount.body, mount.device)) {}
  std::vector<Channel> channels() const override { return {{device_.name + "/0/value", "1", 1, 0.0, 1.0, 0.0}}; }
  void apply(std::span<const double> values) override { mount_.actions.command(number_, values[0]); }

 private:
  std::uint32_t number_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::UserAction& action, const Mount& mount) {
  return std::make_unique<UserAction>(action, mount);
}

}  // namespace cohort::actuation
