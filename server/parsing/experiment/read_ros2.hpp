// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/experiment.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// Reads the key `ros2` of an experiment with the teams `teams`; reports problems. `world` is null if it could not be
/// read; then robots are not selected.
Ros2 read_ros2(const YamlMap& top, const World* world, const std::vector<Team>& teams, const YamlReport& report);

}  // namespace cohort::parsing
