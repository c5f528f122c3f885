// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/keys/key_values.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// Returns the names of the keys of a table entry.
std::vector<std::string> names_of_keys(const Extension& part);

/// Reads the values of a YAML map with the keys of `part`. A vector, a point or a pose is a text or a list of numbers;
/// a repeated key has a value or a list of values. Reports invalid values, which are omitted. `fill`: an absent key
/// gets its fallback, or is reported if it has none. Keys that are groups are left to the caller.
KeyValues read_values(const YamlNode& node, const std::string& path, const Extension& part, bool fill,
                      const YamlReport& report);

}  // namespace cohort::parsing
