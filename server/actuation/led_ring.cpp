// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Colours of LEDs. Each is a marker that cameras see and, if it has an intensity, a lamp.
class LedRing final : public ActuatorOf<description::LedRing> {
 public:
  LedRing(const description::LedRing& leds, const Mount& mount)
      : ActuatorOf(leds, mount), first_(mount.emitters.of_device(mount.body, mount.device)) {}
  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < device_.count; ++i)
      channels.push_back({device_.name + "/" + std::to_string(i) + "/color", "1", 3, 0.0, 1.0, 0.0});
    return channels;
  }
  void apply(std::span<const double> values) override {
    for (std::uint32_t i = 0; i < device_.count; ++i) {
      const Eigen::Vector3d color(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      mount_.emitters.set_marker(first_.marker + i, color);
      if (device_.intensity > 0.0) mount_.emitters.set_lamp(first_.lamp + i, color);
    }
  }

 private:
  emission::Emitters::OfDevice first_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::LedRing& leds, const Mount& mount) {
  return std::make_unique<LedRing>(leds, mount);
}

}  // namespace cohort::actuation
