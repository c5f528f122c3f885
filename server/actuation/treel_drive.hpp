#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Velocity of the left and the right track over ground [m/s].
class TreelDrive final : public Actuator {
 public:
  TreelDrive(const description::TreelDrive& drive, std::size_t device, physics::World& world, std::uint32_t body)
      : drive_(drive), device_(device), world_(world), body_(body) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::TreelDrive drive_;
  std::size_t device_;
  physics::World& world_;
  std::uint32_t body_;
};

}  // namespace cohort::actuation
