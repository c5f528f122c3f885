// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "server/core/ids.hpp"
#include "server/core/state_visitors.hpp"
#include "server/physics/world/anchors.hpp"

namespace cohort::physics {

/// The memory of a body: its member if it moves, or its solids if it is static.
struct BodyMemory {
  std::uint32_t member = Anchors::nobody;  ///< `nobody`: static
  std::uint32_t first_solid = 0;           ///< for a static body
  std::uint32_t end_of_solids = 0;         ///< for a static body, one past its last
};

/// An instance of a model, and the changes from outside since the world began. A released body is like a static one
/// that was removed and has no solids.
struct PlacedBody : BodyMemory {
  Pose X_WM;  ///< pose at which it was placed; a static body stays there
  std::uint32_t model = 0;
  std::uint32_t slot = 0;        ///< index in BodySlots
  bool is_placed_again = false;  ///< X_WM differs from the description
  bool is_out = false;           ///< a static body was removed
};

/// Hashes the changes of a body from outside; adds nothing if there are none.
inline void hash_changes(const PlacedBody& body, StateHash& hash) {
  if (body.is_placed_again) visit_pose(body.X_WM, StateHasher{hash});
  if (body.is_out) StateHasher{hash}(body.is_out);
}

inline void save_changes(const std::vector<PlacedBody>& bodies, SnapshotWriter& writer) {
  const StateSaver save{writer};
  writer.add_count(bodies.size());
  for (const PlacedBody& body : bodies) {
    save(body.is_placed_again);
    if (body.is_placed_again) visit_pose(body.X_WM, save);
    save(body.is_out);
  }
}

/// Restores saved changes by repeating them on the bodies of `engine`, a world. Afterwards all bodies are in the world
/// except static ones that were removed.
template <class Engine>
void restore_changes(SnapshotReader& reader, Engine& engine) {
  const StateRestorer restore{reader};
  reader.expect_count(engine.body_count(), "bodies in its world");
  for (std::uint32_t body = 0; body < engine.body_count(); ++body) {
    bool is_placed_again = false;
    restore(is_placed_again);
    if (is_placed_again) {
      Pose X_WM;
      restore_pose(reader, X_WM);
      engine.place_body(BodyId{body}, X_WM);
    }
    bool is_out = false;
    restore(is_out);
    engine.set_present(BodyId{body}, !is_out);
  }
}

}  // namespace cohort::physics
