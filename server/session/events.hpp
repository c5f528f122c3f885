#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cohort::session {

/// Something that happened in a run and that its record should tell. Kinds: `joined`, `lost`, `back`, `refused`,
/// `superseded`, `missed`, `rejected`, `quarantined`, `event`, `version`, `control`, `failed`, `stopped`.
struct Event {
  std::uint64_t tick = 0;  ///< of the first time
  std::string kind;
  std::string text;
  std::uint64_t count = 1;
};

/// The events of a run. The same again only counts, and so does what exceeds a thousand of its kind: no stranger can
/// fill the memory, nor hide what else happens.
class EventLog {
 public:
  /// True if it is the first of its kind and text.
  bool add(std::uint64_t tick, const std::string& kind, const std::string& text, std::uint64_t count = 1);
  std::span<const Event> events() const { return events_; }

 private:
  static constexpr std::size_t most_of_kind = 1000;
  std::vector<Event> events_;
};

}  // namespace cohort::session
