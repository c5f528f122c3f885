#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// How S leans, from the direction u that is up, against gravity, in S: roll = atan2(u_y, u_z) and
/// pitch = atan2(-u_x, sqrt(u_y^2 + u_z^2)), those of the rotation yaw-pitch-roll from the world to S whatever its yaw
/// (third row of the matrix: Diebel, "Representing attitude", 2006, section 5.6). Both are 0 where there is no gravity.
class Inclinometer final : public Sensor {
 public:
  Inclinometer(const description::Inclinometer& sensor, Mount mount) : sensor_(sensor), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::Inclinometer sensor_;
  Mount mount_;
};

}  // namespace cohort::sensing
