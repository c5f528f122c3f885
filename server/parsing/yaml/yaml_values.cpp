// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/yaml/yaml_values.hpp"

#include <utility>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

bool has_several_numbers(ExtensionValue value) {
  return value == ExtensionValue::point || value == ExtensionValue::vector || value == ExtensionValue::place ||
         value == ExtensionValue::pose;
}

// Returns the text of a value, or all numbers of a list of numbers; empty for anything else.
std::string text_of_value(const YamlNode& node, const ExtensionKey& key) {
  if (node.is_scalar()) return std::string(trimmed(node.text));
  std::string text;
  if (!node.is_list() || !has_several_numbers(key.value)) return text;
  for (const YamlPtr& each : node.items) {
    if (!each->is_scalar()) return {};
    text += (text.empty() ? "" : " ") + each->text;
  }
  return text;
}

}  // namespace

std::vector<std::string> names_of_keys(const Extension& part) {
  std::vector<std::string> names;
  for (const ExtensionKey& key : part.keys) names.emplace_back(key.name);
  return names;
}

KeyValues read_values(const YamlNode& node, const std::string& path, const Extension& part, bool fill,
                      const YamlReport& report) {
  const YamlMap map(node, path, names_of_keys(part), report);
  KeyValues values;
  const auto take = [&](const YamlNode& value, const std::string& where, const ExtensionKey& key) {
    const std::string text = text_of_value(value, key);
    if (std::optional<KeyValues::Value> parsed = parse_value(text, key))
      values.add(key.name, *std::move(parsed));
    else
      report.problem(value, where,
                     text.empty() ? "expected " + expected(key) + ", not " + shown(value) : why_wrong(text, key));
  };
  for (const ExtensionKey& key : part.keys) {
    const std::string name(key.name);
    if (!map.has(name)) {
      if (!fill) continue;
      if (key.required())
        map.require(name, std::string(key.doc));
      else if (key.fallback != no_value && key.value != ExtensionValue::group)
        values.add(key.name, *parse_value(key.fallback, key));
      continue;
    }
    if (key.value == ExtensionValue::group) continue;
    const YamlNode& value = map.where(name);
    if (!key.repeats || !value.is_list()) {
      take(value, map.path_to(name), key);
      continue;
    }
    for (std::size_t i = 0; i < value.items.size(); ++i)
      take(*value.items[i], map.path_to(name) + "[" + std::to_string(i) + "]", key);
  }
  return values;
}

}  // namespace cohort::parsing
