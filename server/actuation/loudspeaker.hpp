#pragma once

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Frequency [Hz] and intensity of one tone.
class Loudspeaker final : public Actuator {
 public:
  Loudspeaker(const description::Loudspeaker& speaker, std::size_t device, Mount mount)
      : speaker_(speaker), mount_(mount), tone_(mount.emitters.of_device(mount.body, device).tone) {}
  std::vector<Channel> channels() const override;
  void apply(std::span<const double> values) override { mount_.emitters.set_tone(tone_, values[0], values[1]); }

 private:
  description::Loudspeaker speaker_;
  Mount mount_;
  std::uint32_t tone_;
};

}  // namespace cohort::actuation
