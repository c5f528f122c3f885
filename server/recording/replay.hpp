#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/recording/recording.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::recording {

/// Runs the world of a recording again, from what the barrier gave out and what was done to it: no controller, no
/// policy, no wall clock. One thread.
class Replay {
 public:
  /// Stands before the first boundary. `recording` must outlive this.
  Replay(const Recording& recording, unsigned threads);
  ~Replay();

  /// Goes on to the last boundary before `log_time` at which a world begins or a snapshot was taken, if it is before
  /// it, and from there to the first one that is not before it. False if there is none.
  bool seek(std::chrono::nanoseconds log_time);

  /// Goes on to the next boundary. False at the end. Throws McapError for a recording that cannot be read or replayed
  /// from here on, and what Simulation throws.
  bool advance();

  /// What is recorded of this boundary, and the world as it is there. To be asked only where `seek` or `advance` has
  /// returned true: after an exception there may be no world, and `seek` is the way back.
  const RecordedTick& recorded() const { return *recorded_; }
  const Simulation& simulation() const { return *simulation_; }
  const description::Experiment& experiment() const { return *experiment_; }

  /// Whether what is recorded and what is replayed have the same state here.
  bool is_identical() const { return recorded_->state_hash == simulation_->state_hash(); }

 private:
  void begin_world(const WorldBegins& begins);
  void apply_commands();
  void take_actions();

  const Recording& recording_;
  unsigned threads_;
  TickStream ticks_;
  std::optional<RecordedTick> recorded_;
  std::unique_ptr<description::Experiment> experiment_;  // outlives the simulation
  std::unique_ptr<Simulation> simulation_;
};

/// What a replay found.
struct Verification {
  std::uint64_t boundaries = 0;  ///< compared, and the same
  struct Difference {
    std::uint64_t tick = 0;
    std::chrono::nanoseconds log_time{0};
    std::uint64_t recorded = 0;
    std::uint64_t replayed = 0;
  };
  std::optional<Difference> difference{};  ///< the first
  std::string problem{};                   ///< why the replay ended before the recording did; empty if it did not
};

/// Replays and compares the state of every boundary from one log time to another, up to the first that differs.
/// `progress` is called at each of them with its log time; if it returns false the replay ends.
Verification verify(Replay& replay, std::chrono::nanoseconds from, std::chrono::nanoseconds to,
                    const std::function<bool(std::chrono::nanoseconds)>& progress);

}  // namespace cohort::recording
