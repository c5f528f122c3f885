#include "server/parsing/yaml/yaml_map.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "server/core/text.hpp"

namespace cohort::parsing {

YamlMap::YamlMap(const YAML::Node& node, std::string path, const std::vector<std::string>& known,
                 const YamlReport& report)
    : node_(node), path_(std::move(path)), report_(report) {
  if (!node_.IsMap()) {
    report_.problem(node_, path_, "expected 'KEY: VALUE' lines, not " + shown(node_));
    return;
  }
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : shown(entry.first);
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      report_.problem(entry.first, path_to(key), "unknown key" + suggestion(key, known));
      if (const auto meant = nearest(key, known)) misspelt_.insert(*meant);
    } else if (!seen.insert(key).second) {
      report_.problem(entry.first, path_to(key), "the key is given twice");
    }
  }
}

YAML::Node YamlMap::value(const std::string& key) const {
  // A const node is looked into, a mutable one would get the key.
  const YAML::Node& map = node_;
  return map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
}

void YamlMap::require(const std::string& key, const std::string& doc) const {
  if (node_.IsMap() && !has(key) && !misspelt_.contains(key)) problem(key, "missing: " + doc);
}

std::optional<std::string> YamlMap::text(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const YAML::Node node = value(key);
  if (node.IsScalar() && !trimmed(node.Scalar()).empty()) return std::string(trimmed(node.Scalar()));
  problem(key, "expected text, not " + shown(node));
  return std::nullopt;
}

std::optional<double> YamlMap::real(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const YAML::Node node = value(key);
  const std::optional<double> number = node.IsScalar() ? parse_real(node.Scalar()) : std::nullopt;
  if (number && std::isfinite(*number)) return number;
  problem(key, "expected a number, not " + shown(node));
  return std::nullopt;
}

std::optional<std::uint64_t> YamlMap::whole(const std::string& key, std::uint64_t least, std::uint64_t greatest) const {
  if (!has(key)) return std::nullopt;
  const YAML::Node node = value(key);
  const std::optional<std::uint64_t> number = node.IsScalar() ? parse_whole(node.Scalar()) : std::nullopt;
  if (number && *number >= least && *number <= greatest) return number;
  problem(key, "expected a whole number from " + std::to_string(least) + " to " + std::to_string(greatest) + ", not " +
                   shown(node));
  return std::nullopt;
}

std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar: {
      constexpr std::size_t most = 60;  // a whole file may be one scalar
      const std::string& text = node.Scalar();
      return "'" + (text.size() <= most ? text : text.substr(0, most) + "…") + "'";
    }
    case YAML::NodeType::Sequence: return "a list";
    case YAML::NodeType::Map: return "a map";
    default: return "nothing";
  }
}

}  // namespace cohort::parsing
