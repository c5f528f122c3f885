// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {

/// Converts seconds to a time; returns nothing if it is less than 0 s or does not fit into nanoseconds.
std::optional<std::chrono::nanoseconds> schedule_time(double seconds);

/// Selects whether an absent key has its fallback as its value.
enum class Fallbacks { taken, left_out };

/// The values of one map of an experiment, with their positions in the file. Reports problems.
class ScheduleEntry {
 public:
  /// `map` and `report` must outlive this.
  ScheduleEntry(const YamlNode& map, std::string path, const Extension& part, const YamlReport& report,
                Fallbacks fallbacks = Fallbacks::taken);

  const KeyValues& values() const { return values_; }
  /// Returns whether the file has the key.
  bool is_written(const std::string& key) const { return map_.find(key) != nullptr; }
  /// Reports a problem at the key, or at the map if it has no such key.
  void problem(const std::string& key, std::string message) const;
  /// Reports a problem of the whole map.
  void problem(std::string message) const { report_.problem(map_, path_, std::move(message)); }

  /// Returns the time of a key in seconds; nothing, with a report, if it is too long.
  std::optional<std::chrono::nanoseconds> time(const std::string& key) const;
  /// Returns the objects that the key `objects` selects, ascending; reports selectors that match none.
  std::vector<std::size_t> objects(const World& world) const;

 private:
  const YamlNode& map_;
  std::string path_;
  const YamlReport& report_;
  KeyValues values_;
};

}  // namespace cohort::parsing
