#pragma once

#include <chrono>

#include "server/viewing/scene_messages.hpp"
#include "tools/view/messages/topics.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {

/// Publishes what a source shows, as far as somebody reads it. One thread.
class ScenePublisher {
 public:
  explicit ScenePublisher(Topics& topics) : topics_(topics) {}

  /// Publishes it unless it was published last. Returns the revision that it has with viewers.
  std::uint32_t show(viewing::Scene scene, std::chrono::nanoseconds time);
  /// Publishes it with the revision that it has.
  void show_as_it_is(viewing::Scene scene, std::chrono::nanoseconds time);
  /// Of the scene that was shown last.
  void show(const viewing::SceneFrame& frame, std::chrono::nanoseconds time);
  void show(const viewing::SceneSignals& signals, std::chrono::nanoseconds time);

  template <recording::RosMessage Message>
  void publish(Topic topic, const Message& message, std::chrono::nanoseconds time) {
    topics_.publish(topic, time, recording::encode(message));
  }
  bool is_read(Topic topic) const { return topics_.is_read(topic); }

 private:
  Topics& topics_;
  viewing::Scene scene_;
  recording::Bytes scene_bytes_;
  viewing::SceneSignals signals_;
  std::uint32_t revision_of_markers_ = 0;
};

}  // namespace cohort::view
