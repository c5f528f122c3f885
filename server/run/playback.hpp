// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace cohort::session {

enum class PlaybackState {
  stopped,  ///< paused at the beginning
  playing,
  paused,
};

/// Decides whether a run continues from its boundary. Pure logic. Not thread-safe.
class Playback {
 public:
  /// Requested steps: the client, and the tick at which they are done.
  struct Steps {
    std::uint64_t client = 0;
    std::uint64_t number = 0;
    std::uint64_t until = 0;  ///< tick at which they are done
  };

  explicit Playback(PlaybackState state = PlaybackState::playing) : state_(state) {}

  /// Returns the state as clients see it: playing while steps are left.
  PlaybackState state() const { return steps_.empty() ? state_ : PlaybackState::playing; }
  /// Returns the state after all steps are done.
  PlaybackState state_without_steps() const { return state_; }
  bool holds() const { return state() != PlaybackState::playing; }

  /// Sets the state from now on. Cancels and returns the remaining steps.
  std::vector<Steps> set(PlaybackState state) {
    state_ = state;
    return std::exchange(steps_, {});
  }
  /// Adds `count` ticks to the remaining steps, after which the run is paused. The run must not be playing without
  /// steps.
  void step(std::uint64_t tick, std::uint64_t count, std::uint64_t client, std::uint64_t number) {
    state_ = PlaybackState::paused;
    steps_.push_back({client, number, (steps_.empty() ? tick : steps_.back().until) + count});
  }
  /// Notes that the run has reached boundary `tick`, and returns the steps that are done.
  std::vector<Steps> reached(std::uint64_t tick) {
    std::vector<Steps> done;
    while (!steps_.empty() && steps_.front().until <= tick) {
      done.push_back(steps_.front());
      steps_.erase(steps_.begin());
    }
    return done;
  }
  bool has_steps() const { return !steps_.empty(); }

 private:
  PlaybackState state_;
  std::vector<Steps> steps_;  // in their order
};

}  // namespace cohort::session
