#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// The world's temperature and humidity and what the sources around add (description::ClimateSource).
class ClimateSensor final : public Sensor {
 public:
  ClimateSensor(const description::ClimateSensor& sensor, Mount mount) : sensor_(sensor), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::ClimateSensor sensor_;
  Mount mount_;
};

}  // namespace cohort::sensing
