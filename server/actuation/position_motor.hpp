#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Where one joint goes, and stays [rad] or [m].
class PositionMotor final : public Actuator {
 public:
  PositionMotor(const description::PositionMotor& motor, const description::Joint& joint, Mount mount)
      : motor_(motor), joint_(joint), mount_(mount) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::PositionMotor motor_;
  description::Joint joint_;
  Mount mount_;
};

}  // namespace cohort::actuation
