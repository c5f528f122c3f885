#pragma once

#include "server/actuation/actuator.hpp"
#include "server/actuation/user_actions.hpp"

namespace cohort::actuation {

/// Tells that the robot does something, from 0 to 1.
class UserAction final : public Actuator {
 public:
  UserAction(const description::UserAction& action, std::size_t device, Mount mount)
      : action_(action), number_(mount.actions.of_device(mount.body, device)), mount_(mount) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::UserAction action_;
  std::uint32_t number_;
  Mount mount_;
};

}  // namespace cohort::actuation
