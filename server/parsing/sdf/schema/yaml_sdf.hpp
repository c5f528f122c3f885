// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/yaml/yaml_document.hpp"

/// SDF in YAML (docs/worlds-in-yaml.md): the same elements with the same nesting. The schema of SDF decides which keys
/// are attributes and which are elements. A list repeats an element, and keys in a `cohort:` element get its prefix.
namespace cohort::parsing {

/// Returns the <sdf> element for a YAML document, with the lines of the YAML file. Adds problems of the document to
/// `problems`; the affected elements are omitted, or read as they were probably meant.
XmlNode sdf_of_yaml(const YamlNode& document, const std::filesystem::path& file, std::vector<Problem>& problems);

/// Returns whether a YAML document is a world or a model rather than an experiment: whether `world`, `model` or `sdf`
/// has a map (or a list of maps).
bool is_sdf_in_yaml(const YamlNode& document);

/// Returns an <sdf> element as YAML, from which `sdf_of_yaml` makes the same element, except for lines, the order of
/// attributes, and implied prefixes. Numbers are written as in the tree.
std::string yaml_of_sdf(const XmlNode& sdf);

}  // namespace cohort::parsing
