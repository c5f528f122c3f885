#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace cohort::ros2 {

/// Notifications from threads of DDS to the bridge's thread. All calls but the constructor's are safe on any thread.
class RosInbox {
 public:
  struct Message {
    std::size_t input = 0;  ///< which the bridge numbers
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

  /// Returns what has come since the last call, in the order in which it came.
  std::vector<Message> take();
  /// Returns how many messages were dropped because too many waited.
  std::uint64_t dropped() const;
  /// Waits until something has come or `wake` was called, for `at_most`.
  void wait(std::chrono::milliseconds at_most);
  /// A descriptor that poll(2) reports as readable while `wait` would return at once.
  int descriptor() const { return descriptor_; }
  /// Takes back calls of `wake`, as `wait` does.
  void clear();

  static constexpr std::size_t most_messages = 10'000;

 private:
  int descriptor_ = -1;
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  std::uint64_t dropped_ = 0;
};

}  // namespace cohort::ros2
