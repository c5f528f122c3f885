#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// What a gripper knows of itself: its opening, whether it holds something, with what force, and its light barrier.
class GripperSensor final : public Sensor {
 public:
  GripperSensor(const description::Gripper& gripper, std::size_t device, Mount mount)
      : gripper_(gripper), mount_(std::move(mount)), number_(mount_.grippers.of_device(mount_.body, device)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::Gripper gripper_;
  Mount mount_;
  std::uint32_t number_;
};

}  // namespace cohort::sensing
