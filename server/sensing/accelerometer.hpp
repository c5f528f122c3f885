#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// What a mass on springs measures along the axes of S: the acceleration of its origin, the mean over the last step,
/// less gravity. At rest it is g upwards, in free fall 0.
class Accelerometer final : public Sensor {
 public:
  Accelerometer(const description::Accelerometer& sensor, Mount mount) : sensor_(sensor), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;
  bool needs_record() const override { return true; }

 private:
  description::Accelerometer sensor_;
  Mount mount_;
};

}  // namespace cohort::sensing
