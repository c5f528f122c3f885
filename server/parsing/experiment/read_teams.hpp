// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/parsing/parsing.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// Reads a positive time in seconds that fits into nanoseconds; returns nothing if the key is absent or invalid.
std::optional<std::chrono::nanoseconds> read_seconds(const YamlMap& map, const std::string& key);

/// Reads the teams of an experiment: their controllers and policies, and the robots of `world` that they select.
/// `world` is null if it could not be read; then no robots are selected. Reports problems.
std::vector<Team> read_teams(const YamlMap& top, const World* world, const YamlReport& report);

}  // namespace cohort::parsing
