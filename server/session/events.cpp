#include "server/session/events.hpp"

namespace cohort::session {

bool EventLog::add(std::uint64_t tick, const std::string& kind, const std::string& text, std::uint64_t count) {
  std::size_t of_kind = 0;
  for (Event& event : events_) {
    if (event.kind != kind) continue;
    if (event.text == text) {
      event.count += count;
      return false;
    }
    ++of_kind;
  }
  if (of_kind == most_of_kind) {
    add(tick, "more", "further events of the kind '" + kind + "' are only counted", count);
    return false;
  }
  events_.push_back({tick, kind, text, count});
  return true;
}

}  // namespace cohort::session
