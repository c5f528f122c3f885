// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "server/recording/replay.hpp"
#include "server/viewing/scene_maker.hpp"
#include "tools/view/messages/scene_publisher.hpp"

namespace cohort::view {

/// Publishes the state of a replay as messages for viewers. Used on the thread of the replay.
class ReplayPublisher {
 public:
  /// All arguments must outlive this.
  ReplayPublisher(const recording::Recording& recording, const recording::Replay& replay, Topics& topics)
      : recording_(recording), replay_(replay), publisher_(topics) {}

  /// Must be called when the replay has made a new world.
  void begin_world() { is_new_world_ = true; }
  /// Must be called when the replay may have no world.
  void forget_world();
  bool has_scene() const { return maker_.has_value(); }

  /// Publishes the state: the scene if it has changed, poses, signals if they have changed, contacts, and the channels
  /// of these robots. Does nothing without a world.
  void show(std::chrono::nanoseconds log_time, std::uint64_t state_hash, std::span<const std::uint32_t> robots);

 private:
  std::uint32_t run_at(std::chrono::nanoseconds log_time) const;

  const recording::Recording& recording_;
  const recording::Replay& replay_;
  ScenePublisher publisher_;
  std::optional<viewing::SceneMaker> maker_;
  bool is_new_world_ = false;
};

/// Publishes the events of a recording. Returns the reason if not all could be read; empty otherwise.
std::string publish_events(const recording::Recording& recording, Topics& topics);

/// Returns the log time of the last boundary of a recording.
std::chrono::nanoseconds end_of(const recording::Recording& recording);

}  // namespace cohort::view
