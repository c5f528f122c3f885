#include "server/session/events.hpp"

namespace cohort::session {

bool EventLog::add(std::uint64_t tick, const std::string& kind, const std::string& text, std::uint64_t count) {
  for (Event& event : events_) {
    if (event.kind != kind || event.text != text) continue;
    event.count += count;
    return false;
  }
  if (events_.size() == most) {
    if (events_.back().kind != "more") events_.back() = {tick, "more", "further events are only counted", 1};
    events_.back().count += count;
    return false;
  }
  events_.push_back({tick, kind, text, count});
  return true;
}

}  // namespace cohort::session
