#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/keys/key_values.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// The names of the keys of a table entry.
std::vector<std::string> names_of_keys(const Extension& part);

/// The values of a YAML map whose keys are those of `part`. A vector, a point or a pose is a text or a list of numbers;
/// a key that repeats has a value or a list of values. What is wrong is reported, and has no value. `fill`: a key that
/// is absent gets its fallback, or is reported if it has none.
KeyValues read_values(const YamlNode& node, const std::string& path, const Extension& part, bool fill,
                      const YamlReport& report);

}  // namespace cohort::parsing
