#include "server/sensing/contact_sensor.hpp"

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

std::vector<Channel> ContactSensor::channels() const {
  return {{sensor_.name + "/0/touching", "1", 1, 0.0, 1.0, 0.0, false},
          {sensor_.name + "/0/force", "N", 1, 0.0, infinity, 0.0}};
}

bool ContactSensor::is_own(std::uint32_t solid) const {
  const geometry::Solid& own = mount_.world.scene().solid(solid);
  return own.link == sensor_.link && own.collision == sensor_.collision;
}

void ContactSensor::sense(std::uint64_t, std::span<double> values) const {
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

}  // namespace cohort::sensing
