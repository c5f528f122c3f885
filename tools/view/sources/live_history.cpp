// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/live_history.hpp"

#include <algorithm>
#include <span>

namespace cohort::view {

wire::GetHistory LiveHistory::question() const { return {revision_}; }

bool LiveHistory::take(const wire::Reply& reply, std::chrono::nanoseconds step) {
  const auto* const part = reply.get<wire::HistoryPart>();
  if (part == nullptr) throw messages::CdrError("the reply contains no history");
  const auto history = messages::decode<messages::RunHistory>(std::as_bytes(std::span(part->data)));
  keep_interval_ = history.keep_interval;
  first_kept_ = step * static_cast<std::int64_t>(history.first_kept_tick);
  const bool is_another_run = reply.run != run_;
  const bool was_asked_of_it = !is_another_run || revision_ == 0;
  if (is_another_run) begin_run(reply.run, history.begin_tick);
  if (!was_asked_of_it) return true;
  for (const messages::HistoryEvent& event : history.events) add(event, step);
  revision_ = part->revision;
  return is_another_run || !history.events.empty();
}

// Events after the time to which the run has gone back are dropped.
void LiveHistory::begin_run(std::uint32_t run, std::uint64_t begin_tick) {
  run_ = run;
  revision_ = 0;
  std::erase_if(events_.events, [&](const ViewEvent& event) { return event.tick >= begin_tick; });
}

void LiveHistory::add(const messages::HistoryEvent& event, std::chrono::nanoseconds step) {
  std::vector<ViewEvent>& events = events_.events;
  std::erase_if(events, [&](const ViewEvent& known) { return known.kind == event.kind && known.text == event.text; });
  if (events.size() == ViewEvents::most) events.erase(events.begin());
  const auto time_of = [&](std::uint64_t tick) { return (step * static_cast<std::int64_t>(tick)).count(); };
  events.push_back({time_of(event.tick), event.tick, event.kind, event.text, event.count, time_of(event.last_tick)});
}

}  // namespace cohort::view
