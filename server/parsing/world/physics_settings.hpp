#pragma once

#include <chrono>
#include <optional>
#include <sdf/Physics.hh>
#include <string>

#include "server/description/world.hpp"
#include "server/parsing/keys/key_values.hpp"
#include "server/parsing/sdf/sdf_report.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// The step that SDF's <physics> says, or nothing. Another engine than Bullet is named by a warning.
std::optional<std::chrono::nanoseconds> read_step(const sdf::Physics* physics, const SdfReport& report);

/// Settings of which the keys of `cohort:physics` that are given replace those of `settings`.
PhysicsSettings with_values(PhysicsSettings settings, const KeyValues& values);

/// The keys of `cohort:physics` in YAML, only those that are there. What is wrong with them is reported.
KeyValues read_physics_map(const YamlNode& node, const std::string& path, const YamlReport& report);

}  // namespace cohort::parsing
