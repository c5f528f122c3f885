// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// Reads the course of an experiment: `events`, `stop`, `print`, `history` and `record`. Reports problems.
class ScheduleReader {
 public:
  ScheduleReader(const YamlMap& top, std::filesystem::path file, const YamlReport& report)
      : top_(top), file_(std::move(file)), report_(report) {}

  /// Returns the objects that events add, which are read with the world.
  std::vector<LaterObject> later_objects() const;

  /// Reads everything into `experiment`, whose world has been read.
  void read(Experiment& experiment) const;

 private:
  struct Written;    // one entry of a list: its kind and the map of its keys
  struct ReadEvent;  // an event and its position
  std::vector<Written> entries(const std::string& list, bool have_times) const;
  static void choose_kind(const YamlMap& map, const std::vector<std::string>& kinds, Written& written);
  static void read_when(const YamlMap& map, Written& written);
  void read_events(Experiment& experiment) const;
  std::vector<ReadEvent> read_event(const Written& written, const World& world) const;
  std::vector<ReadEvent> read_spawn(const Written& written, Experiment& experiment) const;
  std::optional<Reaction> read_on(const Written& written, const World& world) const;
  void check_order(const World& world, const std::vector<ReadEvent>& events,
                   const std::vector<Event>& at_any_time) const;
  void read_stops(Experiment& experiment) const;
  void read_prints(Experiment& experiment) const;
  void read_history(Experiment& experiment) const;
  void read_recorded(Experiment& experiment) const;

  const YamlMap& top_;
  std::filesystem::path file_;
  const YamlReport& report_;
};

}  // namespace cohort::parsing
