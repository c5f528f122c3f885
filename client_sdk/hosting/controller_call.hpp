#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

/// Which controller's code runs now, for messages about a process that this code ends, crashes or holds up.
namespace cohort {

/// A controller, or a plugin, as messages name it: `the controller 'wander' of sbot_3 (team swarm)`.
class Callee {
 public:
  explicit Callee(std::string text) : text_(std::move(text)) {}
  Callee(const std::string& controller, const std::string& robot, const std::string& team);
  Callee(const Callee&) = delete;
  Callee& operator=(const Callee&) = delete;
  ~Callee();  ///< waits for those that read the text

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// A call of a controller's code that is under way as long as this lives. One at a time in a process is told about; it
/// costs five stores.
class ControllerCall {
 public:
  /// `what`: such as `step`; lives as long as the program.
  ControllerCall(const Callee& callee, const char* what, std::uint64_t tick) noexcept;
  ControllerCall(const ControllerCall&) = delete;
  ControllerCall& operator=(const ControllerCall&) = delete;
  ~ControllerCall();
};

/// The call that is under way.
struct CallUnderWay {
  const Callee* callee = nullptr;  ///< none: none is
  const char* what = nullptr;
  std::uint64_t tick = 0;
  bool is_on_this_thread = false;
};
/// Returns the call that is under way. Also for signal handlers; on another thread than that of the call, its callee
/// may be gone at any time.
CallUnderWay call_under_way() noexcept;

/// Returns `the controller '…' of … has not returned from step` for the call that is under way. Any thread may ask.
std::optional<std::string> describe_call();

}  // namespace cohort
