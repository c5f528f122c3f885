// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "client_sdk/src/attachment.hpp"
#include "tools/view/driving/held_command.hpp"
#include "tools/view/source.hpp"

namespace cohort::view {

/// Returns controllers that follow `command`, which must outlive them. Calls `begun` whenever one is started.
ControllerKind obedient_controllers(HeldCommand& command, std::function<void()> begun);

/// Drives one robot for a page, as a client of the server. It answers each frame at once with the latest command.
class Driver {
 public:
  /// Claims the robot, on a separate thread, once `after` is ready. Calls `claimed` once, on that thread, when the
  /// robot is driven, or with the reason why it is not.
  Driver(ClientOptions options, std::function<void(const Answer&)> claimed, std::shared_future<void> after);
  /// Releases the robot, which takes about 0.1 s.
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  HeldCommand& command() { return command_; }
  /// Returns whether the robot was assigned to this driver, which may have ended since.
  bool has_begun() const { return has_begun_; }
  /// Starts to release the robot, without waiting. Any thread.
  void leave() { leaves_ = true; }
  bool has_ended() const;
  /// Returns a future that becomes ready when the robot is released.
  std::shared_future<void> end() const { return ended_; }
  /// Returns the reason why the driver has ended.
  std::string why() const;

 private:
  void run(const std::shared_future<void>& after);
  std::string drive();
  void limit_claim(const std::stop_token& stop);
  void tell(Severity severity, const std::string& text);
  void answer(const Answer& answer);

  ClientOptions options_;
  HeldCommand command_;
  std::atomic<bool> has_begun_{false};
  std::atomic<bool> leaves_{false};
  std::promise<void> end_;
  std::shared_future<void> ended_{end_.get_future()};
  mutable std::mutex mutex_;
  std::function<void(const Answer&)> claimed_;  // until it was called
  std::string told_;
  std::string why_;
  std::thread thread_;
};

}  // namespace cohort::view
