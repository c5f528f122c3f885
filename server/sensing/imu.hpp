#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Orientation and angular velocity of S, and the acceleration that a mass on springs in it measures: that of its
/// origin, the mean over the last step, less gravity; at rest it is g upwards. The orientation is the rotation of S in
/// its frame of reference (REP 145; SDF 1.9, <orientation_reference_frame>).
class Imu final : public Sensor {
 public:
  Imu(const description::Imu& imu, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;
  bool needs_record() const override { return true; }

 private:
  description::Imu imu_;
  Mount mount_;
  Eigen::Quaterniond R_RW_;  // R: the frame of reference
};

}  // namespace cohort::sensing
