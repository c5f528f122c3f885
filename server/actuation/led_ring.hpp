#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// The colours of LEDs, each as a marker that cameras see and, if it has an intensity, as a lamp.
class LedRing final : public Actuator {
 public:
  LedRing(const description::LedRing& leds, std::size_t device, Mount mount)
      : leds_(leds), mount_(mount), first_(mount.emitters.of_device(mount.body, device)) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override;

 private:
  description::LedRing leds_;
  Mount mount_;
  emission::Emitters::OfDevice first_;
};

}  // namespace cohort::actuation
