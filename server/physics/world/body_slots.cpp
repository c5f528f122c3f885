// SPDX-License-Identifier: Apache-2.0
#include "server/physics/world/body_slots.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

bool BodySlots::take(PlacedBody& body, std::optional<std::uint32_t> saved) {
  std::map<std::uint32_t, BodyMemory>& free = free_[body.model];
  const auto found = saved ? free.find(*saved) : free.begin();
  if (found != free.end()) {
    body.slot = found->first;
    static_cast<BodyMemory&>(body) = found->second;
    free.erase(found);
    return true;
  }
  if (saved && *saved != next_) throw std::invalid_argument("slot " + std::to_string(*saved) + " is not free");
  body.slot = next_++;
  return false;
}

void BodySlots::release(PlacedBody& body, const Pose& X_WL, const description::World& description) {
  const Pose X_WM = X_WL * description.models[body.model].links[0].X_ML.inverse();
  if (X_WM.position.allFinite() && X_WM.orientation.coeffs().allFinite()) body.X_WM = X_WM;
  body.is_placed_again = false;
  body.is_out = true;
  free_[body.model].emplace(std::exchange(body.slot, World::released), body);
  static_cast<BodyMemory&>(body) = {};
}

}  // namespace cohort::physics
