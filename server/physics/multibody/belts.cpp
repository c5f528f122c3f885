// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/belts.hpp"

#include <algorithm>
#include <stdexcept>

namespace cohort::physics {

Belts::Belts(const Mechanism& mechanism) {
  for (const description::Device& device : mechanism.model().devices)
    for (const description::BeltPlace& place : description::belts_of(device)) {
      const Mechanism::LinkPlace& link = mechanism.link(place.link);
      if (std::ranges::any_of(belts_, [&](const RunningLink& other) { return other.link == place.link; }))
        throw std::invalid_argument("'" + description::name_of(device) + "' drives the link '" +
                                    mechanism.model().links[place.link].name + "', which already has a belt");
      belts_.push_back({place.link, static_cast<std::size_t>(link.segment), link.X_SL.orientation * place.axis_L});
    }
}

void Belts::unload() {
  for (RunningLink& belt : belts_) belt.force = 0.0;
}

void Belts::load(std::size_t link, const std::vector<Pose>& X_WS, const Eigen::Vector3d& outward_W,
                 const Eigen::Vector3d& force_W) {
  for (RunningLink& belt : belts_) {
    if (belt.link != link) continue;
    const RunningSurface at_unit_velocity{X_WS[belt.segment].orientation * belt.axis_S, 1.0};
    belt.force -= force_W.dot(at_unit_velocity.velocity_at(outward_W));
  }
}

RunningSurface Belts::of_link(std::size_t link, const std::vector<Pose>& X_WS) const {
  for (const RunningLink& belt : belts_)
    if (belt.link == link) return {X_WS[belt.segment].orientation * belt.axis_S, belt.velocity};
  return {};
}

}  // namespace cohort::physics
