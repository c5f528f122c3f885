#pragma once

#include <deque>
#include <map>
#include <mutex>

#include "idl/messages/scene_messages.hpp"
#include "tools/view/history/history_thread.hpp"

namespace cohort::view {

/// The channels of a server's robots since the view began to receive them. It keeps a bounded number of bytes, and
/// forgets the oldest messages beyond. Any thread.
class SeenValues {
 public:
  static constexpr std::size_t most_bytes = std::size_t{64} << 20U;

  explicit SeenValues(std::size_t most = most_bytes) : most_(most) {}

  /// Sets the robots' channels.
  void set_scene(const messages::Scene& scene);
  /// Takes the bytes of SceneRobots. If the run has gone back, later values are forgotten.
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
