#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// What the motor of a joint gave over the last step.
class TorqueSensor final : public Sensor {
 public:
  TorqueSensor(const description::TorqueSensor& sensor, const description::Joint& joint, Mount mount)
      : sensor_(sensor), joint_(joint), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t, std::span<double> values) const override {
    values[0] = mount_.world.joint_effort(mount_.body, sensor_.joint);
  }

 private:
  description::TorqueSensor sensor_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::sensing
