#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/parsing/parsing.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// Reads a time in seconds that is more than nothing and fits into nanoseconds; nothing if the key is absent or wrong.
std::optional<std::chrono::nanoseconds> read_seconds(const YamlMap& map, const std::string& key);

/// Reads the teams of an experiment: their controllers and policies, and the robots of `world` that they select. Null
/// is a world that could not be read: nothing is selected then. What is wrong goes to the report.
std::vector<Team> read_teams(const YamlMap& top, const World* world, const YamlReport& report);

}  // namespace cohort::parsing
