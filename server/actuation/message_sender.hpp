#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// A message to the robots around: sent at every tick for as long as `sending` is at least 0.5.
class MessageSender final : public Actuator {
 public:
  MessageSender(const description::RangeAndBearing& device, std::size_t index, Mount mount)
      : device_(device), mount_(mount), beacon_(mount.emitters.of_device(mount.body, index).beacon) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override {
    mount_.emitters.set_beacon(beacon_, values[0] >= 0.5, values.subspan(1));
  }

 private:
  description::RangeAndBearing device_;
  Mount mount_;
  std::uint32_t beacon_;
};

}  // namespace cohort::actuation
