#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"

/// What has happened in a run and how far back it can go, for those who look on: docs/protocol.md, "Control",
/// GetHistory.
namespace cohort::messages {

/// Something that happened, perhaps more than once.
struct HistoryEvent {
  std::uint64_t tick = 0;       ///< of the first time
  std::uint64_t last_tick = 0;  ///< of the last time
  std::uint64_t count = 1;
  std::string kind;  ///< a word
  std::string text;
  static constexpr const char* type = "cohort_msgs/msg/HistoryEvent";
  static constexpr auto fields = std::tuple(
      field("tick", &HistoryEvent::tick), field("last_tick", &HistoryEvent::last_tick),
      field("count", &HistoryEvent::count), field("kind", &HistoryEvent::kind), field("text", &HistoryEvent::text));
};

struct RunHistory {
  std::uint64_t begin_tick = 0;       ///< that the run began or went on from
  std::uint64_t keep_interval = 0;    ///< ticks between snapshots that are kept; 0: the run cannot go back
  std::uint64_t first_kept_tick = 0;  ///< of those that are kept, if there are any
  std::uint64_t last_kept_tick = 0;
  std::vector<HistoryEvent> events;  ///< that happened, or happened again, since what is already known
  static constexpr const char* type = "cohort_msgs/msg/RunHistory";
  static constexpr auto fields =
      std::tuple(field("begin_tick", &RunHistory::begin_tick), field("keep_interval", &RunHistory::keep_interval),
                 field("first_kept_tick", &RunHistory::first_kept_tick),
                 field("last_kept_tick", &RunHistory::last_kept_tick), field("events", &RunHistory::events));
};

}  // namespace cohort::messages
