#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Infrared sensors under a robot, each a ray along -z of the link. The reading is 1 - d / range for a surface at
/// distance d, 0 if there is none within range, as over a hole (thesis, section 3.2.2).
class GroundSensors final : public Sensor {
 public:
  GroundSensors(const description::GroundSensors& sensors, Mount mount) : sensors_(sensors), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::GroundSensors sensors_;
  Mount mount_;
};

}  // namespace cohort::sensing
