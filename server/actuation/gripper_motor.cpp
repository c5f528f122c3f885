// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Opening of a gripper: from 0 (closed) to 1.
class GripperMotor final : public ActuatorOf<description::Gripper> {
 public:
  GripperMotor(const description::Gripper& gripper, const Mount& mount)
      : ActuatorOf(gripper, mount), number_(mount.grippers.of_device(mount.body, mount.device)) {}
  std::vector<Channel> channels() const override { return {{device_.name + "/0/opening", "1", 1, 0.0, 1.0, 1.0}}; }
  void apply(std::span<const double> values) override { mount_.grippers.command(number_, values[0]); }

 private:
  std::uint32_t number_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::Gripper& gripper, const Mount& mount) {
  return std::make_unique<GripperMotor>(gripper, mount);
}

}  // namespace cohort::actuation
