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

/// Controllers that obey `command`, which must outlive them; `begun` is called whenever one is started.
ControllerKind obedient_controllers(HeldCommand& command, std::function<void()> begun);

/// Drives one robot for a page, as a client of the server: answers each frame at once with what was given last.
class Driver {
 public:
  /// Claims the robot, on a thread of its own, as soon as `after` is there. `claimed` is called there, once: when the
  /// robot is driven, or with the reason why it is not.
  Driver(ClientOptions options, std::function<void(const Answer&)> claimed, std::shared_future<void> after);
  /// Leaves the robot; takes a tenth of a second or so.
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  HeldCommand& command() { return command_; }
  /// The robot was given to it. It may have ended since.
  bool has_begun() const { return has_begun_; }
  /// Does not wait for it. Any thread.
  void leave() { leaves_ = true; }
  bool has_ended() const;
  /// There when the robot is left.
  std::shared_future<void> end() const { return ended_; }
  /// Why it has ended.
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
