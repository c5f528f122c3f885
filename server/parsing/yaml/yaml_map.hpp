#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Puts problems with YAML nodes into a list.
class YamlReport {
 public:
  YamlReport(std::filesystem::path file, std::vector<Problem>& problems)
      : file_(std::move(file)), problems_(problems) {}

  void problem(const YAML::Node& node, const std::string& element, std::string message) const {
    problems_.push_back({file_, node.Mark().line + 1, element, std::move(message)});
  }

 private:
  std::filesystem::path file_;
  std::vector<Problem>& problems_;
};

/// Reads the values of a YAML map and reports what is wrong with them. A value that is absent or wrong is nothing.
class YamlMap {
 public:
  /// `path` is where the map stands, such as `teams[0]`; empty at the top of the file. Keys other than `known` are
  /// reported, and so is a node that is no map: then there are no values.
  YamlMap(const YAML::Node& node, std::string path, const std::vector<std::string>& known, const YamlReport& report);

  bool has(const std::string& key) const { return static_cast<bool>(value(key)); }
  /// Of the key, or of the map if the key is absent.
  YAML::Node where(const std::string& key) const { return has(key) ? value(key) : node_; }
  std::string path_to(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  /// Reports the key if it is absent, unless an unknown one was taken for it.
  void require(const std::string& key, const std::string& doc) const;
  void problem(const std::string& key, std::string message) const {
    report_.problem(where(key), path_to(key), std::move(message));
  }

  /// Text that is not empty.
  std::optional<std::string> text(const std::string& key) const;
  /// A finite number.
  std::optional<double> real(const std::string& key) const;
  /// A whole number from `least` to `greatest`.
  std::optional<std::uint64_t> whole(const std::string& key, std::uint64_t least, std::uint64_t greatest) const;

 private:
  YAML::Node value(const std::string& key) const;

  YAML::Node node_;
  std::string path_;
  const YamlReport& report_;
  std::set<std::string> misspelt_;  // known keys that unknown ones were taken for
};

/// What a node is, for messages: its text in quotes, or `a list`, `a map`, `nothing`.
std::string shown(const YAML::Node& node);

}  // namespace cohort::parsing
