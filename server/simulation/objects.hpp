#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/experiment.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort {

/// Where the root link of an object was at a tick.
struct PastPose {
  std::uint64_t tick = 0;
  Pose X_WL;
};

/// Everything in a world under its scoped name: the instances of the description, then what was added. An object's
/// index is that of its body. Names form a hierarchy by their slashes.
class Objects {
 public:
  Objects(const description::Experiment& experiment, physics::World& world);

  std::uint32_t size() const { return static_cast<std::uint32_t>(names_.size()); }
  const std::string& name(std::uint32_t object) const { return names_[object]; }
  std::optional<std::uint32_t> find(const std::string& name) const;
  /// All whose names begin with `scope` and a slash, ascending; all there are if it is empty.
  std::vector<std::uint32_t> in_scope(const std::string& scope) const;

  /// In the world: neither taken out nor still to come. A quarantined one is.
  bool is_present(std::uint32_t object) const { return present_[object] != 0; }
  bool is_quarantined(std::uint32_t object) const { return is_present(object) && !world_.is_active(object); }
  void set_present(std::uint32_t object, bool present);
  /// Throws std::invalid_argument if the name is taken, or the model is a robot's or cannot be simulated.
  std::uint32_t add(const std::string& name, std::size_t model, const Pose& X_WM);

  /// Keeps the poses of those that the experiment asks for, at a boundary.
  void record(std::uint64_t tick);
  /// Oldest first; empty if nobody asked for it.
  const std::deque<PastPose>& history(std::uint32_t object) const;

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// After the world is restored.
  void restore(SnapshotReader& reader);

 private:
  const description::Experiment& experiment_;
  physics::World& world_;
  std::vector<std::string> names_;
  std::vector<char> present_;
  std::uint64_t history_ticks_ = 1;
  std::vector<std::deque<PastPose>> histories_;  // in the order of History::objects
};

/// As many ticks as it takes for so much time to pass, at least 1.
std::uint64_t ticks_of(std::chrono::nanoseconds time, std::chrono::nanoseconds step);

}  // namespace cohort
