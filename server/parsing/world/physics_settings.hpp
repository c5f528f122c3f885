// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "server/description/world.hpp"
#include "server/parsing/keys/key_values.hpp"
#include "server/parsing/sdf/sdf_report.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// Returns the step in <physics> of SDF, or nothing. Warns of an engine other than Bullet.
std::optional<std::chrono::nanoseconds> read_step(const Element& world, const SdfReport& report);

/// Returns `settings` with the given keys of `cohort:physics` replaced.
PhysicsSettings with_values(PhysicsSettings settings, const KeyValues& values);

/// Reads the given keys of `cohort:physics` in YAML; reports problems.
KeyValues read_physics_map(const YamlNode& node, const std::string& path, const YamlReport& report);

}  // namespace cohort::parsing
