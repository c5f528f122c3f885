#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// The pressure of the air at the height of S above the sea, as of the International Standard Atmosphere (ICAO Doc
/// 7488, its lowest layer, continued above and below): p = p0 (1 - L h / T0)^(g M / (R L)).
class AirPressureSensor final : public Sensor {
 public:
  AirPressureSensor(const description::AirPressureSensor& sensor, Mount mount)
      : sensor_(sensor), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::AirPressureSensor sensor_;
  Mount mount_;
};

/// At `height` above the sea [m], in Pa; 0 where the formula has no air.
double standard_pressure(double height);

}  // namespace cohort::sensing
