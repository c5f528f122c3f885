// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cohort::session {

/// An event of a run for its record. Kinds: `joined`, `lost`, `back`, `refused`, `superseded`, `missed`, `rejected`,
/// `quarantined`, `unconverged`, `event`, `version`, `control`, `unsent`, `unsaved`, `unrecorded`, `forgotten`,
/// `rewound`, `other_build`, `dropped`, `failed`, `stopped`.
struct RunEvent {
  std::uint64_t tick = 0;  ///< tick of the first occurrence
  std::string kind;
  std::string text;
  std::uint64_t count = 1;
  std::uint64_t last_tick = 0;  ///< tick of the last occurrence, in an EventLog
};

/// The events of a run. Repetitions, and events beyond a thousand of one kind, are only counted: an untrusted client
/// can neither fill the memory nor hide other events.
class EventLog {
 public:
  /// Adds an event. Returns true if it is the first of its kind and text.
  bool add(std::uint64_t tick, const std::string& kind, const std::string& text, std::uint64_t count = 1);
  std::span<const RunEvent> events() const { return events_; }

  /// Returns the number of additions so far, for `changed_since`.
  std::uint64_t revision() const { return revision_; }
  /// Returns the events that occurred, or occurred again, since that revision: at most `most`, in order of their last
  /// change, oldest first. Sets `revision` to that of the last returned event.
  std::vector<RunEvent> changed_since(std::uint64_t& revision, std::size_t most) const;

 private:
  static constexpr std::size_t most_of_kind = 1000;
  std::vector<RunEvent> events_;
  std::vector<std::uint64_t> changed_at_;  // revision of each event
  std::uint64_t revision_ = 0;
};

}  // namespace cohort::session
