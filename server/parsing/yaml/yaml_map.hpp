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

/// Puts problems with YAML nodes into a list.
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

/// Reads the values of a YAML map and reports what is wrong with them. A value that is absent or wrong is nothing.
class YamlMap {
 public:
  /// `path` is where the map stands, such as `teams[0]`; empty at the top of the file. Keys other than `known` are
  /// reported, and so is a node that is no map: then there are no values. `node` must outlive this.
  YamlMap(const YamlNode& node, std::string path, const std::vector<std::string>& known, const YamlReport& report);

  bool has(const std::string& key) const { return node_.find(key) != nullptr; }
  /// Of the key, or of the map if the key is absent.
  const YamlNode& where(const std::string& key) const { return has(key) ? *node_.find(key) : node_; }
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
  const YamlNode& node_;
  std::string path_;
  const YamlReport& report_;
  std::set<std::string> misspelt_;  // known keys that unknown ones were taken for
};

}  // namespace cohort::parsing
