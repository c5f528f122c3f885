// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_events.hpp"

#include <algorithm>

namespace cohort::session {

bool EventLog::add(std::uint64_t tick, const std::string& kind, const std::string& text, std::uint64_t count) {
  std::size_t of_kind = 0;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    RunEvent& event = events_[i];
    if (event.kind != kind) continue;
    if (event.text == text) {
      event.count += count;
      event.last_tick = tick;
      changed_at_[i] = ++revision_;
      return false;
    }
    ++of_kind;
  }
  if (of_kind == most_of_kind) {
    add(tick, "more", "further events of the kind '" + kind + "' are counted but not listed", count);
    return false;
  }
  events_.push_back({tick, kind, text, count, tick});
  changed_at_.push_back(++revision_);
  return true;
}

std::vector<RunEvent> EventLog::changed_since(std::uint64_t& revision, std::size_t most) const {
  std::vector<std::size_t> changed;
  changed.reserve(events_.size());
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (changed_at_[i] > revision) changed.push_back(i);
  std::ranges::sort(changed, {}, [&](std::size_t i) { return changed_at_[i]; });
  if (changed.size() > most) changed.resize(most);
  std::vector<RunEvent> events;
  events.reserve(changed.size());
  for (const std::size_t i : changed) events.push_back(events_[i]);
  if (!changed.empty()) revision = changed_at_[changed.back()];
  return events;
}

}  // namespace cohort::session
