// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/replay_publisher.hpp"

#include <algorithm>

#include "server/recording/run_messages.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {

void ReplayPublisher::forget_world() {
  maker_.reset();
  is_new_world_ = false;
}

std::uint32_t ReplayPublisher::run_at(std::chrono::nanoseconds log_time) const {
  std::uint32_t run = 0;
  for (const auto& world : recording_.worlds())
    if (world.log_time <= log_time) run = world.begins.run;
  return run;
}

void ReplayPublisher::show(std::chrono::nanoseconds log_time, std::uint64_t state_hash,
                           std::span<const std::uint32_t> robots) {
  const Simulation* const simulation = is_new_world_ || maker_ ? &replay_.simulation() : nullptr;
  if (is_new_world_ || (maker_ && maker_->is_outdated())) {
    is_new_world_ = false;
    const std::uint32_t revision = publisher_.show(viewing::SceneMaker(*simulation, 0).scene(), log_time);
    maker_.emplace(*simulation, revision);
  }
  if (!maker_) return;
  publisher_.show(maker_->frame(run_at(log_time), state_hash), log_time);
  publisher_.show(maker_->signals(), log_time);
  if (publisher_.is_read(Topic::contacts)) publisher_.publish(Topic::contacts, maker_->contacts(), log_time);
  if (!publisher_.is_read(Topic::robots)) return;
  messages::SceneRobots channels;
  channels.robots.reserve(robots.size());
  for (const std::uint32_t robot : robots)
    if (robot < simulation->robot_count()) channels.robots.push_back(maker_->robot(robot));
  publisher_.publish(Topic::robots, channels, log_time);
}

std::string publish_events(const recording::Recording& recording, Topics& topics) {
  ViewEvents events;
  std::string problem;
  const recording::Channel* const channel = recording.reader().channel(recording::RecordedEvent::topic);
  if (channel != nullptr) {
    recording::MessageStream messages = recording.reader().messages({.channels = {channel->id}});
    try {
      while (const auto message = messages.next()) {
        if (events.events.size() == ViewEvents::most) break;
        const auto event = messages::decode<recording::RecordedEvent>(message->data);
        const auto time = static_cast<std::int64_t>(message->log_time.count());
        events.events.push_back({time, event.tick, event.kind, event.text, event.count, time});
      }
    } catch (const std::exception& error) {
      problem = error.what();
    }
  }
  topics.publish(Topic::events, std::chrono::nanoseconds(0), messages::encode(events));
  return problem;
}

std::chrono::nanoseconds end_of(const recording::Recording& recording) {
  std::chrono::nanoseconds end{0};
  if (recording.reader().channel(recording::Boundary::topic) == nullptr) return end;
  for (const recording::Block& block : recording.reader().blocks())
    end = std::max(end, std::chrono::nanoseconds(block.end_time));
  return end;
}

}  // namespace cohort::view
