// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

/// Tracks which controller's code is running, for messages about a process that this code ends, crashes or blocks.
namespace cohort {

/// A controller or a plugin, with its name in messages: `the controller 'wander' of sbot_3 (team swarm)`.
class Callee {
 public:
  explicit Callee(std::string text) : text_(std::move(text)) {}
  Callee(const std::string& controller, const std::string& robot, const std::string& team);
  Callee(const Callee&) = delete;
  Callee& operator=(const Callee&) = delete;
  ~Callee();  ///< waits for readers of the text

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// A call of a controller's code, active during the lifetime of this object. Only one call per process is tracked;
/// tracking costs five stores.
class ControllerCall {
 public:
  /// `what` is the called function, such as `step`; it must live as long as the program.
  ControllerCall(const Callee& callee, const char* what, std::uint64_t tick) noexcept;
  ControllerCall(const ControllerCall&) = delete;
  ControllerCall& operator=(const ControllerCall&) = delete;
  ~ControllerCall();
};

/// The active call.
struct CallUnderWay {
  const Callee* callee = nullptr;  ///< null: no call is active
  const char* what = nullptr;
  std::uint64_t tick = 0;
  bool is_on_this_thread = false;
};
/// Returns the active call. May be used in signal handlers. If the call is on another thread, its callee may be
/// destroyed at any time.
CallUnderWay call_under_way() noexcept;

/// Returns `the controller '…' of … has not returned from step` for the active call. Thread-safe.
std::optional<std::string> describe_call();

}  // namespace cohort
