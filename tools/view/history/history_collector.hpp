// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "tools/view/history/history_request.hpp"
#include "tools/view/history/reduction.hpp"

namespace cohort::view {

/// Receives the values of robots in chronological order, and keeps those that a request selects.
class HistoryCollector {
 public:
  /// `request` must outlive this.
  explicit HistoryCollector(const HistoryRequest& request);

  /// Sets the channels of a robot from now on; see `find_value`.
  template <class Channels>
  void set_channels(std::uint32_t robot, const Channels& observation, const Channels& command) {
    for (Wanted& each : wanted_) {
      if (each.robot != robot) continue;
      each.place = find_value(observation, command, *each.name);
      if (each.place) each.unit = each.place->unit;
      each.is_known = each.is_known || each.place;
    }
  }
  /// Adds all observed and all commanded values of a robot. Either of them may be empty.
  void add(std::uint32_t robot, std::chrono::nanoseconds time, std::span<const double> observation,
           std::span<const double> command);

  /// Adds the samples of this collector to another one, as far as that one selects them.
  void copy_to(HistoryCollector& other) const;
  /// Returns true if samples were left out.
  bool is_reduced() const;

  /// Returns the series of all selected values that exist.
  ValueHistory history() const;
  /// Returns an answer with the history, or one that says that no robot has such a value.
  Answer answer(std::string text, std::optional<std::chrono::nanoseconds> next = {}) const;

 private:
  struct Wanted {
    std::uint32_t robot;
    const std::string* name;
    Reduction reduction;
    std::optional<ValuePlace> place{};
    std::string unit{};
    bool is_known = false;
    bool was_reduced = false;  // before its samples were copied
  };
  std::vector<Wanted> wanted_;
};

}  // namespace cohort::view
