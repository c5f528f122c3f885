// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Contact of one collision in the last step, and its force: the sum of the normal impulses of its contact points,
/// divided by the duration of the step.
class ContactSensor final : public SensorOf<description::ContactSensor> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/touching", "1", 1, 0.0, 1.0, 0.0, false},
            {device_.name + "/0/force", "N", 1, 0.0, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    double impulse = 0.0;
    values[0] = 0.0;
    for (const physics::Contact& contact : mount_.world.contacts()) {
      const bool is_touched = (contact.body_a == mount_.body && is_own(contact.solid_a)) ||
                              (contact.body_b == mount_.body && is_own(contact.solid_b));
      if (!is_touched) continue;
      values[0] = 1.0;
      impulse += contact.impulse;
    }
    values[1] = impulse / std::chrono::duration<double>(mount_.description.step).count();
  }

 private:
  bool is_own(std::uint32_t solid) const {
    const geometry::Solid& own = mount_.world.scene().solid(solid);
    return own.link() == device_.link && own.collision() == device_.collision;
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::ContactSensor& sensor, const Mount& mount) {
  return std::make_unique<ContactSensor>(sensor, mount);
}

}  // namespace cohort::sensing
