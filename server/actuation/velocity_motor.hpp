#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Velocity of one joint [rad/s] or [m/s].
class VelocityMotor final : public Actuator {
 public:
  VelocityMotor(const description::VelocityMotor& motor, const description::Joint& joint, physics::World& world,
                std::uint32_t body)
      : motor_(motor), joint_(joint), world_(world), body_(body) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::VelocityMotor motor_;
  description::Joint joint_;
  physics::World& world_;
  std::uint32_t body_;
};

}  // namespace cohort::actuation
