// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "server/description/world.hpp"
#include "server/physics/world/placed_body.hpp"

namespace cohort::physics {

/// Hands out the memory of a world's bodies in slots. A slot of a body that was released serves the next body of the
/// same model, so that a world does not grow while objects come and go.
class BodySlots {
 public:
  /// Gives a new body the lowest free slot of its model, with the member and the solids of the body that had it, or
  /// else the next new slot. Returns true if the slot was used before. `saved`: the slot that the body had in a
  /// snapshot. Throws std::invalid_argument if that is neither free nor the next one.
  bool take(PlacedBody& body, std::optional<std::uint32_t> saved);
  /// Frees the slot of a removed body, which then has neither a member nor solids. `X_WL`: the last pose of its root
  /// link.
  void release(PlacedBody& body, const Pose& X_WL, const description::World& description);

 private:
  std::map<std::uint32_t, std::map<std::uint32_t, BodyMemory>> free_;  // by model, then by slot
  std::uint32_t next_ = 0;
};

}  // namespace cohort::physics
