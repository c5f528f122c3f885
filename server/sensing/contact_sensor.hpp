#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Whether one collision touched anything in the last step, and how hard it was pressed: the sum of the normal impulses
/// of its contact points, over the duration of the step.
class ContactSensor final : public Sensor {
 public:
  ContactSensor(const description::ContactSensor& sensor, Mount mount) : sensor_(sensor), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  bool is_own(std::uint32_t solid) const;

  description::ContactSensor sensor_;
  Mount mount_;
};

}  // namespace cohort::sensing
