#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// The force of a joint's child on its parent over the last step, in the xy plane of the parent (thesis, section 1.1).
class TractionSensor final : public Sensor {
 public:
  TractionSensor(const description::TractionSensor& sensor, const description::Joint& joint, Mount mount)
      : sensor_(sensor), joint_(joint), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;
  bool needs_record() const override { return true; }

 private:
  description::TractionSensor sensor_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::sensing
