#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Velocity of the left and the right track over ground [m/s].
class TreelDrive final : public Actuator {
 public:
  TreelDrive(const description::TreelDrive& drive, std::size_t device, Mount mount)
      : drive_(drive), device_(device), mount_(mount) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::TreelDrive drive_;
  std::size_t device_;
  Mount mount_;
};

}  // namespace cohort::actuation
