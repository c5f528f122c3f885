// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/ctl/ctl_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

using nlohmann::ordered_json;

double seconds_at(std::uint64_t tick, std::chrono::nanoseconds step) {
  return static_cast<double>(tick) * std::chrono::duration<double>(step).count();
}

std::vector<RunEvent> by_first_time(std::vector<RunEvent> events) {
  std::ranges::stable_sort(events, {}, &RunEvent::tick);
  return events;
}

}  // namespace

std::string history_text(const RunHistory& history, std::chrono::nanoseconds step) {
  std::string text;
  for (const RunEvent& event : by_first_time(history.events)) {
    text += fmt::format("{:10.3f} s  {:<11} {}", seconds_at(event.tick, step), event.kind, event.text);
    if (event.count > 1)
      text += fmt::format(" ({} times, last at {:.3f} s)", event.count, seconds_at(event.last_tick, step));
    text += "\n";
  }
  if (history.keep_interval == 0) return text;
  return text + fmt::format("snapshots to go back to: from {:.3f} s to {:.3f} s, one every {:g} s\n",
                            seconds_at(history.first_kept_tick, step), seconds_at(history.last_kept_tick, step),
                            seconds_at(history.keep_interval, step));
}

std::string history_json(const RunHistory& history, std::chrono::nanoseconds step) {
  ordered_json events = ordered_json::array();
  for (const RunEvent& event : by_first_time(history.events))
    events.push_back({{"tick", event.tick},
                      {"last_tick", event.last_tick},
                      {"count", event.count},
                      {"kind", event.kind},
                      {"text", event.text}});
  ordered_json json = {{"step_ns", step.count()}, {"begin_tick", history.begin_tick}, {"events", events}};
  if (history.keep_interval > 0)
    json["kept"] = {{"first_tick", history.first_kept_tick},
                    {"last_tick", history.last_kept_tick},
                    {"interval", history.keep_interval}};
  return json_text(json, 2) + "\n";
}

}  // namespace cohort::tool
