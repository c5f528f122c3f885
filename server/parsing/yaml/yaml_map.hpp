// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/parsing.hpp"
#include "server/parsing/yaml/yaml_document.hpp"

namespace cohort::parsing {

/// Adds problems with YAML nodes to a list.
class YamlReport {
 public:
  YamlReport(std::filesystem::path file, std::vector<Problem>& problems)
      : file_(std::move(file)), problems_(problems) {}

  void problem(const YamlNode& node, const std::string& element, std::string message) const {
    problems_.push_back({file_, node.line, element, std::move(message)});
  }

 private:
  std::filesystem::path file_;
  std::vector<Problem>& problems_;
};

/// Reads the values of a YAML map and reports problems. Returns nothing for an absent or invalid value.
class YamlMap {
 public:
  /// `path` is the position of the map, such as `teams[0]`; empty at the top of the file. Reports keys other than
  /// `known`, and a node that is not a map, which has no values. `node` must outlive this.
  YamlMap(const YamlNode& node, std::string path, const std::vector<std::string>& known, const YamlReport& report);

  bool has(const std::string& key) const { return node_.find(key) != nullptr; }
  /// Returns the node of the key, or the map if the key is absent.
  const YamlNode& where(const std::string& key) const { return has(key) ? *node_.find(key) : node_; }
  std::string path_to(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  /// Reports the key if it is absent, unless an unknown key probably is a misspelling of it.
  void require(const std::string& key, const std::string& doc) const;
  void problem(const std::string& key, std::string message) const {
    report_.problem(where(key), path_to(key), std::move(message));
  }

  /// Returns a text that is not empty.
  std::optional<std::string> text(const std::string& key) const;
  /// Returns a finite number.
  std::optional<double> real(const std::string& key) const;
  /// Returns a whole number from `least` to `greatest`.
  std::optional<std::uint64_t> whole(const std::string& key, std::uint64_t least, std::uint64_t greatest) const;

 private:
  const YamlNode& node_;
  std::string path_;
  const YamlReport& report_;
  std::set<std::string> misspelt_;  // known keys that unknown ones were taken for
};

}  // namespace cohort::parsing
