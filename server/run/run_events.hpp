#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cohort::session {

/// Something that happened in a run and that its record should tell. Kinds: `joined`, `lost`, `back`, `refused`,
/// `superseded`, `missed`, `rejected`, `quarantined`, `event`, `version`, `control`, `unsent`,
/// `unsaved`, `unrecorded`, `forgotten`, `rewound`, `other_build`, `dropped`, `failed`, `stopped`.
struct RunEvent {
  std::uint64_t tick = 0;  ///< of the first time
  std::string kind;
  std::string text;
  std::uint64_t count = 1;
  std::uint64_t last_tick = 0;  ///< in an EventLog: of the last time
};

/// The events of a run. The same again only counts, and so does what exceeds a thousand of its kind: no stranger can
/// fill the memory, nor hide what else happens.
class EventLog {
 public:
  /// True if it is the first of its kind and text.
  bool add(std::uint64_t tick, const std::string& kind, const std::string& text, std::uint64_t count = 1);
  std::span<const RunEvent> events() const { return events_; }

  /// How often anything was added. The state of the log, for `changed_since`.
  std::uint64_t revision() const { return revision_; }
  /// What has happened, or happened again, since that revision; at most `most`, those whose last change is oldest, in
  /// its order. `revision` becomes that of the last one of them.
  std::vector<RunEvent> changed_since(std::uint64_t& revision, std::size_t most) const;

 private:
  static constexpr std::size_t most_of_kind = 1000;
  std::vector<RunEvent> events_;
  std::vector<std::uint64_t> changed_at_;  // revision of each event
  std::uint64_t revision_ = 0;
};

}  // namespace cohort::session
