// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "idl/messages/run_history.hpp"
#include "idl/wire/control_messages.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {

/// The history of a server's runs, collected from its replies. Not thread-safe.
class LiveHistory {
 public:
  /// Returns the request for the part of the history that is not known yet.
  wire::GetHistory question() const;
  /// Adds the reply to `question`. `step` is the step size. Returns whether anything is new. Throws messages::CdrError
  /// if the reply contains no history.
  bool take(const wire::Reply& reply, std::chrono::nanoseconds step);

  /// Returns the latest events, in the order of their last occurrence.
  const ViewEvents& events() const { return events_; }
  /// Returns whether the run can go back in time.
  bool can_go_back() const { return keep_interval_ > 0; }
  std::chrono::nanoseconds first_kept() const { return first_kept_; }

 private:
  void begin_run(std::uint32_t run, std::uint64_t begin_tick);
  void add(const messages::HistoryEvent& event, std::chrono::nanoseconds step);

  std::uint32_t run_ = 0;
  std::uint64_t revision_ = 0;
  std::uint64_t keep_interval_ = 0;
  std::chrono::nanoseconds first_kept_{0};
  ViewEvents events_;
};

}  // namespace cohort::view
