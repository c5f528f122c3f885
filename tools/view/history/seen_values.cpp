// SPDX-License-Identifier: Apache-2.0
#include "tools/view/history/seen_values.hpp"

#include <algorithm>

#include "tools/view/history/history_collector.hpp"

namespace cohort::view {

void SeenValues::set_scene(const messages::Scene& scene) {
  std::vector<std::shared_ptr<const Channels>> of_model(scene.models.size());
  std::map<std::uint32_t, std::shared_ptr<const Channels>> channels;
  for (const messages::SceneEntity& entity : scene.entities) {
    if (entity.robot == messages::none || entity.model >= of_model.size()) continue;
    auto& model = of_model[entity.model];
    if (model == nullptr)
      model = std::make_shared<const Channels>(
          Channels{scene.models[entity.model].observation, scene.models[entity.model].command});
    channels[entity.robot] = model;
  }
  const std::lock_guard lock(mutex_);
  channels_ = std::move(channels);
}

void SeenValues::add(std::chrono::nanoseconds time, const messages::Bytes& robots) {
  if (robots.empty()) return;
  auto copy = std::make_shared<const messages::Bytes>(robots);
  const std::lock_guard lock(mutex_);
  while (!seen_.empty() && seen_.back().time >= time) {
    bytes_ -= seen_.back().robots->size();
    seen_.pop_back();
  }
  bytes_ += copy->size();
  seen_.push_back({time, std::move(copy)});
  while (bytes_ > most_) {
    bytes_ -= seen_.front().robots->size();
    seen_.pop_front();
  }
}

Answer SeenValues::read(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) const {
  std::vector<Seen> seen;
  HistoryRequest clamped = request;
  {
    const std::lock_guard lock(mutex_);
    seen.assign(seen_.begin(), seen_.end());
  }
  if (!seen.empty()) {
    clamped.from = std::max(clamped.from, seen.front().time);
    clamped.to = std::min(clamped.to, seen.back().time);
  }
  HistoryCollector collector(clamped);
  {
    const std::lock_guard lock(mutex_);
    for (const std::uint32_t robot : request.robots)
      if (const auto found = channels_.find(robot); found != channels_.end())
        collector.set_channels(robot, found->second->observation, found->second->command);
  }
  for (const Seen& each : seen) {
    if (each.time < clamped.from || each.time > clamped.to) continue;
    if (is_cancelled()) break;
    const auto robots = messages::decode<messages::SceneRobots>(*each.robots);
    for (const messages::SceneRobot& robot : robots.robots)
      collector.add(robot.robot, each.time, robot.observation, robot.command);
  }
  return collector.answer("");
}

}  // namespace cohort::view
