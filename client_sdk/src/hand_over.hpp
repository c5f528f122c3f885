#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/event_descriptor.hpp"

namespace cohort {

/// Where a client's thread and the loop of a program meet: one event at a time. The thread offers and waits, the loop
/// takes and answers.
class HandOver {
 public:
  // On the client's thread.

  /// Returns when the loop has answered. Throws LeaveRun if the loop has left, and ControllerFailure if it has failed.
  void offer(const ClientEvent& event);
  void end(ClientEnded ended);

  // By the loop.

  /// Waits for an event until `deadline`, for ever if there is none.
  std::optional<ClientEvent> take(std::optional<std::chrono::steady_clock::time_point> deadline);
  /// Answers the event that was taken, if there is one.
  void answer();
  /// Answers it with a failure.
  void fail(const std::string& why);
  void leave();

  /// Readable while there is something to take.
  int descriptor() const { return descriptor_.get(); }

 private:
  using Lock = std::unique_lock<std::mutex>;

  EventDescriptor descriptor_;
  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  std::optional<ClientEvent> event_;  // is on offer, or was taken and waits for its answer
  bool taken_ = false;
  bool left_ = false;
  std::optional<std::string> failure_;
  std::optional<ClientEnded> ended_;
};

}  // namespace cohort
