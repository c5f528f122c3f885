#include "server/parsing/yaml/yaml_values.hpp"

#include <utility>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

bool has_several_numbers(ExtensionValue value) {
  return value == ExtensionValue::point || value == ExtensionValue::vector || value == ExtensionValue::place ||
         value == ExtensionValue::pose;
}

// The text of a value; of a list of numbers, all of them. Empty if it is something else.
std::string text_of(const YAML::Node& node, const ExtensionKey& key) {
  if (node.IsScalar()) return std::string(trimmed(node.Scalar()));
  std::string text;
  if (!node.IsSequence() || !has_several_numbers(key.value)) return text;
  for (const YAML::Node& each : node) {
    if (!each.IsScalar()) return {};
    text += (text.empty() ? "" : " ") + each.Scalar();
  }
  return text;
}

}  // namespace

std::vector<std::string> names_of_keys(const Extension& part) {
  std::vector<std::string> names;
  for (const ExtensionKey& key : part.keys) names.emplace_back(key.name);
  return names;
}

KeyValues read_values(const YAML::Node& node, const std::string& path, const Extension& part, bool fill,
                      const YamlReport& report) {
  const YamlMap map(node, path, names_of_keys(part), report);
  KeyValues values;
  const auto take = [&](const YAML::Node& value, const std::string& where, const ExtensionKey& key) {
    const std::string text = text_of(value, key);
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
    const YAML::Node value = map.where(name);
    if (!key.repeats || !value.IsSequence()) {
      take(value, map.path_to(name), key);
      continue;
    }
    for (std::size_t i = 0; i < value.size(); ++i)
      take(value[i], map.path_to(name) + "[" + std::to_string(i) + "]", key);
  }
  return values;
}

}  // namespace cohort::parsing
