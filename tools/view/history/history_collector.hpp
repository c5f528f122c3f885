#pragma once

#include <memory>
#include <span>

#include "tools/view/history/history_request.hpp"
#include "tools/view/history/reduction.hpp"

namespace cohort::view {

/// Takes the values of robots in the order of time, and keeps those that a request wants.
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
  /// Takes all observed and commanded values of a robot, or none of one of them.
  void add(std::uint32_t robot, std::chrono::nanoseconds time, std::span<const double> observation,
           std::span<const double> command);

  /// Adds the samples that this has to those of another one that wants them.
  void copy_to(HistoryCollector& other) const;
  /// Returns true if samples were left out.
  bool is_reduced() const;

  /// Returns the series of the values that robots have had.
  ValueHistory history() const;
  /// Answers with the history, or that no robot has such a value.
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
