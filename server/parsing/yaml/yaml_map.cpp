// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/yaml/yaml_map.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "server/core/text.hpp"

namespace cohort::parsing {

YamlMap::YamlMap(const YamlNode& node, std::string path, const std::vector<std::string>& known,
                 const YamlReport& report)
    : node_(node), path_(std::move(path)), report_(report) {
  if (!node_.is_map()) {
    report_.problem(node_, path_, "expected 'KEY: VALUE' lines, not " + shown(node_));
    return;
  }
  std::set<std::string> seen;
  for (const auto& [written, value] : node_.pairs) {
    const std::string key = written->is_scalar() ? written->text : shown(*written);
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      report_.problem(*written, path_to(key), "unknown key" + suggestion(key, known));
      if (const auto meant = nearest(key, known)) misspelt_.insert(*meant);
    } else if (!seen.insert(key).second) {
      report_.problem(*written, path_to(key), "the key is given twice");
    }
  }
}

void YamlMap::require(const std::string& key, const std::string& doc) const {
  if (node_.is_map() && !has(key) && !misspelt_.contains(key)) problem(key, "missing: " + doc);
}

std::optional<std::string> YamlMap::text(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const YamlNode& node = where(key);
  if (node.is_scalar() && !trimmed(node.text).empty()) return std::string(trimmed(node.text));
  problem(key, "expected text, not " + shown(node));
  return std::nullopt;
}

std::optional<double> YamlMap::real(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const YamlNode& node = where(key);
  const std::optional<double> number = node.is_scalar() ? parse_real(node.text) : std::nullopt;
  if (number && std::isfinite(*number)) return number;
  problem(key, "expected a number, not " + shown(node));
  return std::nullopt;
}

std::optional<std::uint64_t> YamlMap::whole(const std::string& key, std::uint64_t least, std::uint64_t greatest) const {
  if (!has(key)) return std::nullopt;
  const YamlNode& node = where(key);
  const std::optional<std::uint64_t> number = node.is_scalar() ? parse_whole(node.text) : std::nullopt;
  if (number && *number >= least && *number <= greatest) return number;
  problem(key, "expected a whole number from " + std::to_string(least) + " to " + std::to_string(greatest) + ", not " +
                   shown(node));
  return std::nullopt;
}

}  // namespace cohort::parsing
