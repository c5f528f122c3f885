#pragma once

#include <chrono>
#include <cstdint>

#include "idl/messages/run_history.hpp"
#include "idl/wire/control_messages.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {

/// The history of a server's runs, put together from its messages piece by piece. Not thread-safe.
class LiveHistory {
 public:
  /// The question that brings what is not known yet.
  wire::GetHistory question() const;
  /// The reply to it, and the time of a tick. Throws messages::CdrError if the reply is none. True if there is
  /// anything new.
  bool take(const wire::Reply& reply, std::chrono::nanoseconds step);

  /// The newest events, in the order of their last time.
  const ViewEvents& events() const { return events_; }
  /// The times to which the run can go back, if any.
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
