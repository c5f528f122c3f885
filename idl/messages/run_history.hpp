// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"

/// The events of a run, and the snapshots to which it can return: docs/protocol.md, "Control", GetHistory.
namespace cohort::messages {

/// An event that happened once or several times.
struct HistoryEvent {
  std::uint64_t tick = 0;       ///< tick of the first occurrence
  std::uint64_t last_tick = 0;  ///< tick of the last occurrence
  std::uint64_t count = 1;
  std::string kind;  ///< keyword
  std::string text;
  static constexpr const char* type = "cohort_msgs/msg/HistoryEvent";
  static constexpr auto fields = std::tuple(
      field("tick", &HistoryEvent::tick), field("last_tick", &HistoryEvent::last_tick),
      field("count", &HistoryEvent::count), field("kind", &HistoryEvent::kind), field("text", &HistoryEvent::text));
};

struct RunHistory {
  std::uint64_t begin_tick = 0;       ///< tick at which the run started or continued
  std::uint64_t keep_interval = 0;    ///< ticks between kept snapshots; 0: the run cannot go back
  std::uint64_t first_kept_tick = 0;  ///< first tick of the kept snapshots, if there are any
  std::uint64_t last_kept_tick = 0;
  std::vector<HistoryEvent> events;  ///< new and repeated events since the known revision
  static constexpr const char* type = "cohort_msgs/msg/RunHistory";
  static constexpr auto fields =
      std::tuple(field("begin_tick", &RunHistory::begin_tick), field("keep_interval", &RunHistory::keep_interval),
                 field("first_kept_tick", &RunHistory::first_kept_tick),
                 field("last_kept_tick", &RunHistory::last_kept_tick), field("events", &RunHistory::events));
};

}  // namespace cohort::messages
