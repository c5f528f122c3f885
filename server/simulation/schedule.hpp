// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/actuation/user_actions.hpp"
#include "server/emission/emitters.hpp"
#include "server/simulation/objects.hpp"

namespace cohort {

/// The schedule of a run, as described by its experiment: its events, the effects of robots' actions, and its stop
/// conditions.
class Schedule {
 public:
  /// Spawns a new object of a spawner with this name, and returns a sentence for the log. Throws std::invalid_argument,
  /// without any change, if it cannot be done.
  using Spawn = std::function<std::string(const description::Spawner& spawner, const std::string& name)>;

  /// Throws std::invalid_argument if an event spawns an object before the first step.
  Schedule(const description::Experiment& experiment, physics::World& world, Objects& objects,
           emission::Emitters& emitters, const actuation::UserActions& actions, Spawn spawn);

  /// Carries out the events of a boundary: first those that are due at its time, then those that the start of an action
  /// triggers. Returns a sentence for each. Throws std::runtime_error if one cannot be carried out.
  std::vector<std::string> begin_tick(std::uint64_t tick);
  /// Carries out an event that was requested from outside, at the boundary of `tick`. Returns a sentence. Throws
  /// std::invalid_argument, without any change, if it cannot be done.
  std::string act_from_outside(const description::Event& event, std::uint64_t tick);
  /// Applies the forces that act during the step that starts at `tick`.
  void push(std::uint64_t tick);
  /// Checks the stop conditions, once at each boundary, until one is met.
  void check_stops();

  /// Returns a human-readable description of the stop condition that is met; nothing if none is.
  const std::optional<std::string>& stop_reason() const { return stop_reason_; }

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// Restores the schedule of a world that is at `tick`.
  void restore(SnapshotReader& reader, std::uint64_t tick);

 private:
  /// The state of an object of the description.
  enum class Stage : std::uint8_t { to_come, came, gone };
  void react(std::uint64_t tick, std::vector<std::string>& happened);
  std::string who_begins(const description::Reaction& reaction) const;
  std::optional<std::string> why_not(const description::Event& event) const;
  std::string act(const description::Event& event);
  std::string spawn_new(const description::SpawnNew& spawn);
  void apply(const description::Event& event);
  std::optional<std::string> why_it_holds(const description::StopCondition& condition) const;

  const description::Experiment& experiment_;
  physics::World& world_;
  Objects& objects_;
  emission::Emitters& emitters_;
  const actuation::UserActions& actions_;
  Spawn spawn_;
  std::vector<std::uint64_t> event_ticks_;
  std::size_t next_event_ = 0;
  std::vector<std::uint64_t> boundaries_held_;  // number of consecutive boundaries at which it held, by stop condition
  std::vector<Stage> stages_;                   // by object
  std::vector<std::uint64_t> force_ends_;  // end of the force of each event of each reaction: it acts before this tick
  std::vector<std::uint64_t> spawned_;     // number of spawned objects, by spawner
  struct Push {
    std::uint32_t object = 0;
    description::ApplyForce force;
    std::uint64_t end = 0;  // it acts before this tick
  };
  template <class Self, class Visit>
  static void visit_outside(Self& self, Visit&& visit);
  // Requests from outside that are still in progress:
  std::vector<Push> pushes_;
  std::vector<std::uint32_t> removed_;  // for good, in order of removal
  std::optional<std::string> stop_reason_;
};

}  // namespace cohort
