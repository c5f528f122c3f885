// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "idl/messages/scene_messages.hpp"
#include "tools/view/messages/topics.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {

/// Publishes the data of a source on topics. Not thread-safe.
class ScenePublisher {
 public:
  explicit ScenePublisher(Topics& topics) : topics_(topics) {}

  /// Publishes a scene with a new revision, unless it equals the last one. Returns the revision that viewers know.
  std::uint32_t show(messages::Scene scene, std::chrono::nanoseconds time);
  /// Publishes a scene with its own revision.
  void show_as_it_is(messages::Scene scene, std::chrono::nanoseconds time);
  /// Publish a frame, or signals, of the last scene.
  void show(const messages::SceneFrame& frame, std::chrono::nanoseconds time);
  void show(const messages::SceneSignals& signals, std::chrono::nanoseconds time);

  template <messages::RosMessage Message>
  void publish(Topic topic, const Message& message, std::chrono::nanoseconds time) {
    topics_.publish(topic, time, messages::encode(message));
  }
  bool is_read(Topic topic) const { return topics_.is_read(topic); }

 private:
  Topics& topics_;
  messages::Scene scene_;
  recording::Bytes scene_bytes_;
  messages::SceneSignals signals_;
  std::uint32_t revision_of_markers_ = 0;
};

}  // namespace cohort::view
