#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Position and velocity of one joint, exact.
class JointEncoder final : public Sensor {
 public:
  JointEncoder(const description::JointEncoder& encoder, const description::Joint& joint, Mount mount)
      : encoder_(encoder), joint_(joint), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::JointEncoder encoder_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::sensing
