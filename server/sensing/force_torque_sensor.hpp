#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// What goes through a joint, over the last step: force, and torque about the origin of the joint, on its parent by its
/// child or the other way round, in the axes of the child, the parent or S (SDF 1.9, <force_torque>). Zero for a planar
/// body.
class ForceTorqueSensor final : public Sensor {
 public:
  ForceTorqueSensor(const description::ForceTorqueSensor& sensor, const description::Joint& joint, Mount mount)
      : sensor_(sensor), joint_(joint), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;
  bool needs_record() const override { return true; }

 private:
  Eigen::Quaterniond axes_W() const;

  description::ForceTorqueSensor sensor_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::sensing
