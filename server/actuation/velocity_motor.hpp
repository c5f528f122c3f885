#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Velocity of one joint [rad/s] or [m/s].
class VelocityMotor final : public Actuator {
 public:
  VelocityMotor(const description::VelocityMotor& motor, const description::Joint& joint, Mount mount)
      : motor_(motor), joint_(joint), mount_(mount) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::VelocityMotor motor_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::actuation
