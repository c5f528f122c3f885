// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/schedule_entry.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "server/description/select_robots.hpp"

namespace cohort::parsing {

std::optional<std::chrono::nanoseconds> schedule_time(double seconds) {
  constexpr double longest = 9e9;  // 285 years, which fits into nanoseconds
  if (!(seconds >= 0.0 && seconds <= longest)) return std::nullopt;
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::round(seconds * 1e9)));
}

ScheduleEntry::ScheduleEntry(const YamlNode& map, std::string path, const Extension& part, const YamlReport& report,
                             Fallbacks fallbacks)
    : map_(map),
      path_(std::move(path)),
      report_(report),
      values_(read_values(map, path_, part, fallbacks == Fallbacks::taken, report)) {}

void ScheduleEntry::problem(const std::string& key, std::string message) const {
  report_.problem(is_written(key) ? *map_.find(key) : map_, path_ + "." + key, std::move(message));
}

std::optional<std::chrono::nanoseconds> ScheduleEntry::time(const std::string& key) const {
  if (!values_.has(key)) return std::nullopt;
  const std::optional<std::chrono::nanoseconds> time = schedule_time(values_.real(key));
  if (!time) problem(key, "expected at most 9e9 s");
  return time;
}

std::vector<std::size_t> ScheduleEntry::objects(const World& world) const {
  std::vector<std::size_t> selected;
  for (const std::string& selector : values_.texts("objects")) {
    try {
      const std::vector<std::size_t> found = select_objects(world, selector);
      selected.insert(selected.end(), found.begin(), found.end());
    } catch (const std::invalid_argument& error) {
      problem("objects", error.what());
    }
  }
  std::sort(selected.begin(), selected.end());
  selected.erase(std::unique(selected.begin(), selected.end()), selected.end());
  return selected;
}

}  // namespace cohort::parsing
