#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/yaml/yaml_document.hpp"

/// SDF in YAML (docs/worlds.md): the same elements, nested in the same way. What is an attribute and what an element is
/// a matter of SDF's schema; a list repeats an element; keys inside of a `cohort:` element have its prefix.
namespace cohort::parsing {

/// The <sdf> element that a YAML document stands for, with the lines of the YAML file. What is wrong with the document
/// goes to `problems`; what it is an element of is then left out, or read as what was probably meant.
XmlNode sdf_of_yaml(const YamlNode& document, const std::filesystem::path& file, std::vector<Problem>& problems);

/// Whether a YAML document is a world or a model, rather than an experiment: whether a map (or a list of maps) stands
/// at `world`, `model` or `sdf`.
bool is_sdf_in_yaml(const YamlNode& document);

/// An <sdf> element as YAML: `sdf_of_yaml` of the text is the same element again, but for lines, for the order of
/// attributes, and for the prefixes that are implied. Numbers are written as they stand in the tree.
std::string yaml_of_sdf(const XmlNode& sdf);

}  // namespace cohort::parsing
