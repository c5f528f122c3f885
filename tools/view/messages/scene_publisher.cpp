// SPDX-License-Identifier: Apache-2.0
#include "tools/view/messages/scene_publisher.hpp"

#include <utility>

#include "tools/view/messages/markers.hpp"

namespace cohort::view {

std::uint32_t ScenePublisher::show(messages::Scene scene, std::chrono::nanoseconds time) {
  scene.revision = scene_.revision;
  recording::Bytes bytes = messages::encode(scene);
  if (scene.revision != 0 && bytes == scene_bytes_) return scene.revision;
  ++scene.revision;
  show_as_it_is(std::move(scene), time);
  return scene_.revision;
}

void ScenePublisher::show_as_it_is(messages::Scene scene, std::chrono::nanoseconds time) {
  scene_ = std::move(scene);
  revision_of_markers_ = 0;
  scene_bytes_ = messages::encode(scene_);
  topics_.publish(Topic::scene, time, scene_bytes_);
}

void ScenePublisher::show(const messages::SceneFrame& frame, std::chrono::nanoseconds time) {
  publish(Topic::frame, frame, time);
  // Only their readers pay for these, by getting them late.
  if (frame.revision != scene_.revision) return;
  if (is_read(Topic::markers) && std::exchange(revision_of_markers_, scene_.revision) != scene_.revision)
    publish(Topic::markers, markers_of(scene_), time);
  if (is_read(Topic::transforms)) publish(Topic::transforms, transforms_of(scene_, frame), time);
}

void ScenePublisher::show(const messages::SceneSignals& signals, std::chrono::nanoseconds time) {
  if (signals == signals_) return;
  signals_ = signals;
  publish(Topic::signals, signals, time);
}

}  // namespace cohort::view
