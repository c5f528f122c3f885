// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/hash.hpp"
#include "server/core/ids.hpp"
#include "server/core/snapshot.hpp"

namespace cohort::physics {

/// The state of a world: everything that determines its further course. Used between steps.
class WorldState {
 public:
  /// Hashes everything that determines the further course of `body`: pose, velocities, joints, tracks, targets,
  /// warm-start impulses.
  virtual void hash_body(BodyId body, StateHash& hash) const = 0;
  /// Hashes every contact point and every connection with their warm-start impulses.
  virtual void hash_contacts(StateHash& hash) const = 0;

  /// Writes the whole state.
  virtual void save(SnapshotWriter& writer) const = 0;
  /// Restores the state into a newly constructed world of the same description. Throws SnapshotError if the snapshot
  /// belongs to something else; the world must not be used then.
  virtual void restore(SnapshotReader& reader) = 0;

 protected:
  ~WorldState() = default;
};

}  // namespace cohort::physics
