// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/experiment.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/simulation/shared_experiment.hpp"

namespace cohort {

/// The pose of an object's root link at a tick.
struct PastPose {
  std::uint64_t tick = 0;
  Pose X_WL;
};

/// All objects in a world by their scoped name: the instances of the description, and those added during the run. An
/// object's index is that of its instance and of its body. Slashes in names form a hierarchy.
class Objects {
 public:
  /// New objects are added to the instances of `experiment`, which must outlive this object. `like`: the objects of
  /// another world that shares the experiment, or null.
  Objects(SharedExperiment& experiment, physics::World& world, const Objects* like = nullptr);

  std::uint32_t size() const { return static_cast<std::uint32_t>(present_.size()); }
  const std::string& name(std::uint32_t object) const { return experiment_->world.instances[object].name; }
  std::optional<std::uint32_t> find(const std::string& name) const;

  /// Returns true if the object is in the world: added and not removed. A quarantined object is in the world.
  bool is_present(std::uint32_t object) const { return present_[object] != 0; }
  bool is_quarantined(std::uint32_t object) const { return is_present(object) && !world_.is_active(BodyId{object}); }
  void set_present(std::uint32_t object, bool present);
  /// Adds an object. Throws std::invalid_argument if the name is taken, or the model cannot be simulated.
  std::uint32_t add(const std::string& name, std::size_t model, const Pose& X_WM);
  /// Returns the number of objects in the description.
  std::uint32_t described() const { return described_; }
  /// Returns true if the object was added and removed again: it never comes back.
  bool is_gone(std::uint32_t object) const { return object >= described_ && !is_present(object); }

  /// Records the poses that the experiment asks for, at a boundary.
  void record(std::uint64_t tick);
  /// Returns the recorded poses, oldest first; empty if the experiment does not ask for them.
  const std::deque<PastPose>& history(std::uint32_t object) const;

  void hash(StateHash& hash) const;
  /// An added object in a snapshot.
  struct Added {
    description::Instance instance;
    std::uint32_t slot = 0;  ///< the slot of its body, also if the object is gone
    bool is_gone = false;
  };
  /// Saves the added objects, before the rest of the world.
  void save_added(SnapshotWriter& writer) const;
  std::vector<Added> read_added(SnapshotReader& reader) const;
  /// Adds a saved object again. Call this for all of them in order, right before the world is restored. The object is
  /// in the world until then, even if it is gone in the snapshot.
  void restore_added(const Added& added);
  void save(SnapshotWriter& writer) const;
  /// Restores the other state. Call this after the world has been restored.
  void restore(SnapshotReader& reader);

 private:
  using ByName = std::unordered_map<std::string, std::uint32_t>;

  void add_instance(description::Instance instance, BodyId body);
  static std::uint64_t hash_of_gone(std::uint32_t object);
  // Limits the number of added objects, as untrusted clients can add robots.
  static constexpr std::size_t most_added = 100'000;

  SharedExperiment& experiment_;
  physics::World& world_;
  std::uint32_t described_;
  std::vector<char> present_;
  std::vector<std::uint32_t> slots_;  // by added object
  StateHash added_hash_;              // hash of the names and models of the added objects
  std::uint64_t gone_hash_ = 0;       // sum over the gone objects
  std::shared_ptr<ByName> by_name_;   // for lookup only, never iterated; shared like the experiment
  std::uint64_t history_ticks_ = 1;
  std::vector<std::deque<PastPose>> histories_;  // in the order of History::objects
};

/// Returns the number of ticks in `time`, rounded up, at least 1.
std::uint64_t ticks_of(std::chrono::nanoseconds time, std::chrono::nanoseconds step);

}  // namespace cohort
