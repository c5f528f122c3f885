// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/event_descriptor.hpp"

namespace cohort {

/// Hands events from a client's thread to the loop of a program, one at a time. The thread offers and waits; the loop
/// takes and answers.
class HandOver {
 public:
  // For the client's thread.

  /// Offers an event and returns when the loop has answered. Throws LeaveRun if the loop has left, ControllerFailure if
  /// it has failed, and NoAnswer if it leaves a frame unanswered.
  void offer(const ClientEvent& event);
  void end(ClientEnded ended);

  // For the loop.

  /// Waits for an event until `deadline`, without limit if there is none.
  std::optional<ClientEvent> take(std::optional<std::chrono::steady_clock::time_point> deadline);
  /// Answers the current event, if there is one.
  void answer();
  /// Releases a frame without an answer, which is allowed only for free robots. Throws std::logic_error otherwise.
  void leave_unanswered();
  /// Answers the current event with a failure.
  void fail(const std::string& why);
  void leave();

  /// Returns a descriptor that is readable while there is an event to take.
  int descriptor() const { return descriptor_.get(); }

 private:
  using Lock = std::unique_lock<std::mutex>;

  EventDescriptor descriptor_;
  std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  std::optional<ClientEvent> event_;  // offered, or taken and not yet answered
  bool taken_ = false;
  bool unanswered_ = false;
  bool left_ = false;
  std::optional<std::string> failure_;
  std::optional<ClientEnded> ended_;
};

}  // namespace cohort
