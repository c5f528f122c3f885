// SPDX-License-Identifier: Apache-2.0

#include "server/actuation/actuator_kinds.hpp"
#include "server/core/infinity.hpp"

namespace cohort::actuation {
namespace {

/// A message to nearby robots, sent at every tick while `sending` is at least 0.5.
class MessageSender final : public ActuatorOf<description::RangeAndBearing> {
 public:
  MessageSender(const description::RangeAndBearing& device, const Mount& mount)
      : ActuatorOf(device, mount), beacon_(mount.emitters.of_device(mount.body, mount.device).beacon) {}
  std::vector<Channel> channels() const override {
    const auto size = static_cast<std::uint32_t>(device_.message_size);
    return {{device_.name + "/0/sending", "1", 1, 0.0, 1.0, 0.0},
            {device_.name + "/0/message", "1", size, -infinity, infinity, 0.0}};
  }
  void apply(std::span<const double> values) override {
    mount_.emitters.set_beacon(beacon_, values[0] >= 0.5, values.subspan(1));
  }

 private:
  std::uint32_t beacon_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::RangeAndBearing& device, const Mount& mount) {
  return std::make_unique<MessageSender>(device, mount);
}

}  // namespace cohort::actuation
