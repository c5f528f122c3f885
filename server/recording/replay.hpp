// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/recording/recording.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::recording {

/// A replay of a recording's world, from the recorded commands and actions: without controllers, policies or wall
/// clock. For one thread.
class Replay {
 public:
  /// Starts before the first boundary. `recording` must outlive this object.
  Replay(const Recording& recording, unsigned threads);
  ~Replay();

  /// Goes to the first boundary that is not before `log_time`. Starts from the last snapshot, or the last start of a
  /// world, before that boundary if this is faster. Returns false if there is no such boundary.
  bool seek(std::chrono::nanoseconds log_time);

  /// Goes to the next boundary. Returns false at the end. Throws McapError for a recording that cannot be read or
  /// replayed from here on, and the exceptions of Simulation.
  bool advance();

  /// Returns the recorded data of this boundary. This and the functions below are valid only where `seek` or `advance`
  /// has returned true. After an exception there may be no world, and `seek` restores one.
  const RecordedTick& recorded() const { return *recorded_; }
  const Simulation& simulation() const { return *simulation_; }
  const description::Experiment& experiment() const { return *experiment_; }

  /// Returns true if the recorded and the replayed state are the same here.
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

/// The result of a replay.
struct Verification {
  std::uint64_t boundaries = 0;  ///< number of compared boundaries that are identical
  struct Difference {
    std::uint64_t tick = 0;
    std::chrono::nanoseconds log_time{0};
    std::uint64_t recorded = 0;
    std::uint64_t replayed = 0;
  };
  std::optional<Difference> difference{};  ///< the first difference
  std::string problem{};                   ///< why the replay ended before the recording; empty if it did not
};

/// Replays and compares the state of every boundary from one log time to another, up to the first that differs.
/// `progress` is called at each boundary with its log time; if it returns false, the replay ends.
Verification verify(Replay& replay, std::chrono::nanoseconds from, std::chrono::nanoseconds to,
                    const std::function<bool(std::chrono::nanoseconds)>& progress);

}  // namespace cohort::recording
