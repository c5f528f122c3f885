#pragma once

#include "server/core/hash.hpp"
#include "server/core/ids.hpp"
#include "server/core/snapshot.hpp"

namespace cohort::physics {

/// The state of a world: all that decides how it goes on. Used between steps.
class WorldState {
 public:
  /// Adds all that decides how `body` goes on: pose, velocities, joints, tracks, targets, warm-start impulses.
  virtual void hash_body(BodyId body, StateHash& hash) const = 0;
  /// Adds every contact point and every connection with what the solver's warm start takes from it.
  virtual void hash_contacts(StateHash& hash) const = 0;

  /// Writes the whole state.
  virtual void save(SnapshotWriter& writer) const = 0;
  /// Reads it into a world as it is after its construction, of the same description. Throws SnapshotError if the
  /// snapshot is of something else; the world is then not to be used.
  virtual void restore(SnapshotReader& reader) = 0;

 protected:
  ~WorldState() = default;
};

}  // namespace cohort::physics
