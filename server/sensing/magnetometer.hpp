#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// The magnetic field of the world, which is the same everywhere, in S.
class Magnetometer final : public Sensor {
 public:
  Magnetometer(const description::Magnetometer& sensor, Mount mount) : sensor_(sensor), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::Magnetometer sensor_;
  Mount mount_;
};

}  // namespace cohort::sensing
