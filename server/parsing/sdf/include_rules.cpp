// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/include_rules.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

// Returns the problem of an element in an <include>, or nothing.
std::optional<std::string> flaw_of_part(const XmlNode& part, const XmlNode& include) {
  static const std::map<std::string, std::vector<std::string>> attributes_of = {
      {"uri", {}},
      {"name", {}},
      {"static", {}},
      {"placement_frame", {}},
      {"namespace", {}},
      {"model_state", {"name"}},
      {"pose", {"relative_to", "degrees", "rotation_format"}},
      {"plugin", {"name", "filename"}}};
  const auto known = attributes_of.find(part.name);
  if (known == attributes_of.end()) {
    std::vector<std::string> names;
    names.reserve(attributes_of.size());
    for (const auto& [name, attributes] : attributes_of) names.push_back(name);
    return "unknown element" + suggestion(part.name, names);
  }
  const bool is_plugin = part.name == "plugin";
  if (!is_plugin && include.child(part.name) != &part) return "<" + part.name + "> is given twice";
  for (const auto& [attribute, value] : part.attributes)
    if (std::find(known->second.begin(), known->second.end(), attribute) == known->second.end())
      return "unknown attribute '" + attribute + "'" + suggestion(attribute, known->second);
  if (is_plugin) return part.text.empty() ? std::nullopt : std::optional<std::string>("unexpected text");
  if (part.name != "pose" && part.name != "model_state" && part.text.empty()) return "expected a value";
  constexpr std::string_view flags[] = {"true", "false", "1", "0"};
  if (part.name == "static" && std::find(std::begin(flags), std::end(flags), part.text) == std::end(flags))
    return "expected true or false, not '" + part.text + "'";
  return std::nullopt;
}

}  // namespace

std::optional<std::pair<const XmlNode*, std::string>> flaw_of_include(const XmlNode& include) {
  for (const auto& [name, value] : include.attributes)
    if (name != "merge" && name.find(':') == std::string::npos)
      return std::pair{&include, "unknown attribute '" + name + "'" + suggestion(name, {"merge"})};
  for (const XmlNode& part : include.children) {
    if (part.name == "experimental:params" && !include.file->is_foreign)
      return std::pair{&part, "parameters of an include are not supported"};
    if (part.name.find(':') != std::string::npos) continue;
    if (const std::optional<std::string> flaw = flaw_of_part(part, include)) return std::pair{&part, *flaw};
  }
  if (include.child("placement_frame") != nullptr && include.child("pose") == nullptr)
    return std::pair{&include, "a <placement_frame> requires a <pose>"};
  return std::nullopt;
}

bool is_merged(const XmlNode& include) {
  const std::string* const merge = include.attribute("merge");
  return merge != nullptr && (*merge == "true" || *merge == "1");
}

}  // namespace cohort::parsing
