// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <mutex>

#include "idl/messages/scene_messages.hpp"
#include "tools/view/history/history_thread.hpp"

namespace cohort::view {

/// The channel values of a server's robots since the view began to receive them. Drops the oldest messages beyond a
/// limit of bytes. Thread-safe.
class SeenValues {
 public:
  static constexpr std::size_t most_bytes = std::size_t{64} << 20U;

  explicit SeenValues(std::size_t most = most_bytes) : most_(most) {}

  /// Sets the robots' channels.
  void set_scene(const messages::Scene& scene);
  /// Adds an encoded SceneRobots message. If the run has gone back, drops later values.
  void add(std::chrono::nanoseconds time, const messages::Bytes& robots);

  Answer read(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) const;

 private:
  struct Seen {
    std::chrono::nanoseconds time{0};
    std::shared_ptr<const messages::Bytes> robots;
  };
  struct Channels {
    std::vector<messages::SceneChannel> observation, command;
  };

  const std::size_t most_;
  mutable std::mutex mutex_;
  std::deque<Seen> seen_;
  std::size_t bytes_ = 0;
  std::map<std::uint32_t, std::shared_ptr<const Channels>> channels_;  // by robot
};

}  // namespace cohort::view
