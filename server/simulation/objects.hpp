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

/// Where the root link of an object was at a tick.
struct PastPose {
  std::uint64_t tick = 0;
  Pose X_WL;
};

/// Everything in a world under its scoped name: the instances of the description, to which what comes in mid-run is
/// added. An object's index is that of its instance and of its body. Names form a hierarchy by their slashes.
class Objects {
 public:
  /// What comes is added to the instances of `experiment`, which must outlive this. `like`: those of another world that
  /// shares it; null: none.
  Objects(SharedExperiment& experiment, physics::World& world, const Objects* like = nullptr);

  std::uint32_t size() const { return static_cast<std::uint32_t>(present_.size()); }
  const std::string& name(std::uint32_t object) const { return experiment_->world.instances[object].name; }
  std::optional<std::uint32_t> find(const std::string& name) const;

  /// In the world: neither taken out nor still to come. A quarantined one is.
  bool is_present(std::uint32_t object) const { return present_[object] != 0; }
  bool is_quarantined(std::uint32_t object) const { return is_present(object) && !world_.is_active(BodyId{object}); }
  void set_present(std::uint32_t object, bool present);
  /// Throws std::invalid_argument if the name is taken, or the model cannot be simulated.
  std::uint32_t add(const std::string& name, std::size_t model, const Pose& X_WM);
  /// How many there were at first.
  std::uint32_t described() const { return described_; }

  /// Keeps the poses of those that the experiment asks for, at a boundary.
  void record(std::uint64_t tick);
  /// Oldest first; empty if nobody asked for it.
  const std::deque<PastPose>& history(std::uint32_t object) const;

  void hash(StateHash& hash) const;
  /// Those that have come, before all else of a world.
  void save_added(SnapshotWriter& writer) const;
  /// Brings them again, right before the world is restored.
  void restore_added(SnapshotReader& reader);
  void save(SnapshotWriter& writer) const;
  /// After the world is restored.
  void restore(SnapshotReader& reader);

 private:
  using ByName = std::unordered_map<std::string, std::uint32_t>;

  void add_instance(description::Instance instance);
  // Each may be a robot's, and a stranger's request may bring it.
  static constexpr std::size_t most_added = 100'000;

  SharedExperiment& experiment_;
  physics::World& world_;
  std::uint32_t described_;
  std::vector<char> present_;
  std::shared_ptr<ByName> by_name_;  // to find one; nobody goes through it. As shared as the experiment is
  std::uint64_t history_ticks_ = 1;
  std::vector<std::deque<PastPose>> histories_;  // in the order of History::objects
};

/// As many ticks as it takes for so much time to pass, at least 1.
std::uint64_t ticks_of(std::chrono::nanoseconds time, std::chrono::nanoseconds step);

}  // namespace cohort
