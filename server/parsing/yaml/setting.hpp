// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/yaml/yaml_document.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::parsing {

/// A value that a user sets in place of one of a file, such as `teams.swarm.parameters.gain=2`.
struct Setting {
  std::string written;            ///< as the user wrote it
  std::vector<std::string> path;  ///< keys from the top of the file; for an item of a list its name or its index
  YamlPtr value;

  std::string path_text() const;
};

/// Reads a setting, PATH=VALUE. The steps of the path are separated by dots. A step with a dot in it stands in double
/// quotes. The value is YAML. Throws std::invalid_argument.
Setting parse_setting(std::string_view text);

/// Returns the document with the value of a setting. Missing maps and keys are added. The value has the line of what it
/// replaces, or of the map to which it is added. Reports an item that a list does not have, and a path below a value;
/// the document is then unchanged.
YamlPtr with_setting(const YamlPtr& document, const Setting& setting, const YamlReport& report);

/// Returns a document with only the value of a setting, below the steps of `path`, which are keys of maps.
YamlPtr document_of(std::span<const std::string> path, const YamlPtr& value, int line);

}  // namespace cohort::parsing
