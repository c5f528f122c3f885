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

/// The schedule of a run, as its experiment has it: its events, what actions of robots make happen, and when it stops.
class Schedule {
 public:
  /// Brings a new object into the world, as a spawner has it and under this name. Returns a sentence. Throws
  /// std::invalid_argument if it cannot be done; nothing is changed then.
  using Spawn = std::function<std::string(const description::Spawner& spawner, const std::string& name)>;

  /// Throws std::invalid_argument if an event brings something before the first step.
  Schedule(const description::Experiment& experiment, physics::World& world, Objects& objects,
           emission::Emitters& emitters, const actuation::UserActions& actions, Spawn spawn);

  /// The events of a boundary: those of its time, then those of the actions that begin. Throws std::runtime_error for
  /// one that cannot be done. Returns a sentence for each.
  std::vector<std::string> begin_tick(std::uint64_t tick);
  /// Does at once what is asked for from outside, at the boundary of `tick`. Returns a sentence. Throws
  /// std::invalid_argument if it cannot be done; nothing is changed then.
  std::string act_from_outside(const description::Event& event, std::uint64_t tick);
  /// Applies the forces that act in the step from `tick` on.
  void push(std::uint64_t tick);
  /// Looks at the stop conditions; once at each boundary, until one holds.
  void check_stops();

  /// The stop condition that holds, in words.
  const std::optional<std::string>& stop_reason() const { return stop_reason_; }

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// With the world at `tick`.
  void restore(SnapshotReader& reader, std::uint64_t tick);

 private:
  /// Of an object of the description.
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
  std::vector<std::uint64_t> boundaries_held_;  // in a row, of each stop condition
  std::vector<Stage> stages_;                   // by object
  std::vector<std::uint64_t> force_ends_;       // of each event of each reaction: its force acts before this tick
  std::vector<std::uint64_t> spawned_;          // how many objects each spawner has brought
  struct Push {
    std::uint32_t object = 0;
    description::ApplyForce force;
    std::uint64_t end = 0;  // it acts before this tick
  };
  template <class Self, class Visit>
  static void visit_outside(Self& self, Visit&& visit);
  // What was asked for from outside and is not over:
  std::vector<Push> pushes_;
  std::vector<std::uint32_t> removed_;  // for good, in the order of their going
  std::optional<std::string> stop_reason_;
};

}  // namespace cohort
