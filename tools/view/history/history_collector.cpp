// SPDX-License-Identifier: Apache-2.0
#include "tools/view/history/history_collector.hpp"

#include <algorithm>

namespace cohort::view {
namespace {

// The nearest number to the time in seconds: 1.23 and not 1.2300000000000002.
double seconds_of(std::chrono::nanoseconds time) { return static_cast<double>(time.count()) / 1e9; }

}  // namespace

HistoryCollector::HistoryCollector(const HistoryRequest& request) {
  wanted_.reserve(request.robots.size() * request.names.size());
  for (const std::uint32_t robot : request.robots)
    for (const std::string& name : request.names)
      wanted_.push_back({robot, &name, Reduction(request.from, request.to, request.points)});
}

void HistoryCollector::add(std::uint32_t robot, std::chrono::nanoseconds time, std::span<const double> observation,
                           std::span<const double> command) {
  for (Wanted& each : wanted_) {
    if (each.robot != robot || !each.place) continue;
    const std::span<const double> values = each.place->is_commanded ? command : observation;
    if (each.place->index < values.size()) each.reduction.add({time, values[each.place->index]});
  }
}

void HistoryCollector::copy_to(HistoryCollector& other) const {
  for (Wanted& to : other.wanted_) {
    const auto from = std::ranges::find_if(
        wanted_, [&](const Wanted& each) { return each.robot == to.robot && *each.name == *to.name; });
    if (from == wanted_.end() || !from->is_known) continue;
    to.is_known = true;
    to.unit = from->unit;
    to.was_reduced = from->reduction.is_reduced();
    for (const Sample& sample : from->reduction.samples()) to.reduction.add(sample);
  }
}

bool HistoryCollector::is_reduced() const {
  return std::ranges::any_of(wanted_,
                             [](const Wanted& each) { return each.was_reduced || each.reduction.is_reduced(); });
}

ValueHistory HistoryCollector::history() const {
  ValueHistory history;
  for (const Wanted& each : wanted_) {
    if (!each.is_known) continue;
    ValueSeries series{.robot = each.robot, .name = *each.name, .unit = each.unit};
    const std::vector<Sample> samples = each.reduction.samples();
    series.times.reserve(samples.size());
    series.values.reserve(samples.size());
    for (const Sample& sample : samples) {
      series.times.push_back(seconds_of(sample.time));
      series.values.push_back(sample.value);
    }
    history.series.push_back(std::move(series));
  }
  history.is_reduced = is_reduced();
  return history;
}

Answer HistoryCollector::answer(std::string text, std::optional<std::chrono::nanoseconds> next) const {
  ValueHistory result = history();
  if (next)
    result.next = seconds_of(*next);
  else if (result.series.empty())
    return {false, text.empty() ? "no robot has such a channel" : text};
  return {true, std::move(text), std::make_shared<const ValueHistory>(std::move(result))};
}

}  // namespace cohort::view
