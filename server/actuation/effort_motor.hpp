#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Torque or force on one joint [N m] or [N].
class EffortMotor final : public Actuator {
 public:
  EffortMotor(const description::EffortMotor& motor, const description::Joint& joint, Mount mount)
      : motor_(motor), joint_(joint), mount_(mount) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::EffortMotor motor_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::actuation
