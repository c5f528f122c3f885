// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

struct YamlNode;
using YamlPtr = std::shared_ptr<const YamlNode>;

/// A node of a YAML document as it is written: duplicate keys are kept, in order, and each node has its line. An alias
/// is the node to which it refers, so nodes may be shared.
struct YamlNode {
  enum class Kind { nothing, scalar, list, map };

  Kind kind = Kind::nothing;
  int line = 0;
  std::string text;                                ///< text of a scalar
  bool is_plain = false;                           ///< a scalar without quotation marks
  std::vector<YamlPtr> items;                      ///< items of a list
  std::vector<std::pair<YamlPtr, YamlPtr>> pairs;  ///< keys and values of a map
  std::size_t size = 1;                            ///< with all nodes below it, those of aliases too
  std::size_t depth = 1;                           ///< depth of the deepest node below it, from this one

  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_list() const { return kind == Kind::list; }
  bool is_map() const { return kind == Kind::map; }
  /// Returns the first value of the key in a map; nullptr if there is none, or if this is not a map.
  const YamlNode* find(std::string_view key) const;
};

struct YamlDocument {
  YamlPtr root;  ///< nullptr if there is an error
  struct Error {
    int line = 0;  ///< 0 if not known
    std::string message;
  };
  std::optional<Error> error;
};

/// Parses a YAML text with one document. Rejects invalid YAML, several documents, control characters, nodes nested
/// deeper than 64, and aliases that expand to more than 10 000 nodes in total or refer to themselves.
YamlDocument parse_yaml(std::string_view text);

/// Returns a node for messages: its text in quotes, or `a list`, `a map`, `nothing`.
std::string shown(const YamlNode& node);

}  // namespace cohort::parsing
