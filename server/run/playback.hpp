#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace cohort::session {

enum class PlaybackState {
  stopped,  ///< as paused, at the beginning
  playing,
  paused,
};

/// Whether a run goes on from the boundary that it stands at. Pure logic. Not thread-safe.
class Playback {
 public:
  /// Whoever asked for steps, and when they are done.
  struct Steps {
    std::uint64_t client = 0;
    std::uint64_t number = 0;
    std::uint64_t until = 0;  ///< tick
  };

  explicit Playback(PlaybackState state = PlaybackState::playing) : state_(state) {}

  /// As others see it: while steps are left the run plays.
  PlaybackState state() const { return steps_.empty() ? state_ : PlaybackState::playing; }
  /// What it comes back to when all steps are done.
  PlaybackState state_without_steps() const { return state_; }
  bool holds() const { return state() != PlaybackState::playing; }

  /// From now on. Steps that are left are given up and returned.
  std::vector<Steps> set(PlaybackState state) {
    state_ = state;
    return std::exchange(steps_, {});
  }
  /// So many ticks more, after the steps that are left already; then it is paused. It must not play without steps.
  void step(std::uint64_t tick, std::uint64_t count, std::uint64_t client, std::uint64_t number) {
    state_ = PlaybackState::paused;
    steps_.push_back({client, number, (steps_.empty() ? tick : steps_.back().until) + count});
  }
  /// The run has come to boundary `tick`: the steps that are done.
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
