// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Frequency [Hz] and intensity of one tone.
class Loudspeaker final : public ActuatorOf<description::Loudspeaker> {
 public:
  Loudspeaker(const description::Loudspeaker& speaker, const Mount& mount)
      : ActuatorOf(speaker, mount), tone_(mount.emitters.of_device(mount.body, mount.device).tone) {}
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/frequency", "Hz", 1, 0.0, device_.max_frequency, 0.0},
            {device_.name + "/0/intensity", "1", 1, 0.0, device_.max_intensity, 0.0}};
  }
  void apply(std::span<const double> values) override { mount_.emitters.set_tone(tone_, values[0], values[1]); }

 private:
  std::uint32_t tone_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::Loudspeaker& speaker, const Mount& mount) {
  return std::make_unique<Loudspeaker>(speaker, mount);
}

}  // namespace cohort::actuation
