#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {

/// Nothing if it is less than 0 s, or more than nanoseconds can count.
std::optional<std::chrono::nanoseconds> schedule_time(double seconds);

/// The values of one map in the course of an experiment, and where they stand. What is wrong goes to the report.
class ScheduleEntry {
 public:
  /// `map` and `report` must outlive this.
  ScheduleEntry(const YamlNode& map, std::string path, const Extension& part, const YamlReport& report);

  const KeyValues& values() const { return values_; }
  /// Whether the file has the key.
  bool is_written(const std::string& key) const { return map_.find(key) != nullptr; }
  /// At the key, or at the map if it has no such key.
  void problem(const std::string& key, std::string message) const;
  /// Of the whole map.
  void problem(std::string message) const { report_.problem(map_, path_, std::move(message)); }

  /// Of a key in seconds; nothing, and reported, if it is too long.
  std::optional<std::chrono::nanoseconds> time(const std::string& key) const;
  /// The objects that the key `objects` selects, ascending; what selects none is reported.
  std::vector<std::size_t> objects(const World& world) const;

 private:
  const YamlNode& map_;
  std::string path_;
  const YamlReport& report_;
  KeyValues values_;
};

}  // namespace cohort::parsing
