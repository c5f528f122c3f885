// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace cohort::ros2 {

/// Notifications from DDS threads to the bridge's thread. All members except the constructor and destructor are
/// thread-safe.
class RosInbox {
 public:
  struct Message {
    std::size_t input = 0;  ///< number that the bridge gave to the topic
    std::vector<std::byte> bytes{};
    std::uint64_t writer = 0;  ///< RosGraph::endpoint
  };

  /// Throws std::system_error.
  RosInbox();
  ~RosInbox();
  RosInbox(const RosInbox&) = delete;
  RosInbox& operator=(const RosInbox&) = delete;

  void put(Message message);
  /// Wakes the thread that waits.
  void wake();

  /// Returns the messages since the last call, in the order of arrival.
  std::vector<Message> take();
  /// Returns how many messages were dropped because `most_messages` were waiting.
  std::uint64_t dropped() const;
  /// Waits until a message has arrived or `wake` was called, for at most `at_most`.
  void wait(std::chrono::milliseconds at_most);
  /// Returns a descriptor that poll(2) reports as readable while `wait` would return at once.
  int descriptor() const { return descriptor_; }
  /// Clears earlier calls of `wake`, as `wait` does.
  void clear();

  static constexpr std::size_t most_messages = 10'000;

 private:
  int descriptor_ = -1;
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  std::uint64_t dropped_ = 0;
};

}  // namespace cohort::ros2
