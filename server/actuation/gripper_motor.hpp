#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// How far a gripper is to be open: from 0, closed, to 1.
class GripperMotor final : public Actuator {
 public:
  GripperMotor(const description::Gripper& gripper, std::size_t device, Mount mount)
      : gripper_(gripper), mount_(mount), number_(mount.grippers.of_device(mount.body, device)) {}
  std::vector<Channel> channels() const override { return {{gripper_.name + "/0/opening", "1", 1, 0.0, 1.0, 1.0}}; }
  void apply(std::span<const double> values) override { mount_.grippers.command(number_, values[0]); }

 private:
  description::Gripper gripper_;
  Mount mount_;
  std::uint32_t number_;
};

}  // namespace cohort::actuation
