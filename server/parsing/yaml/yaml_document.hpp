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

/// A node of a YAML document as it is written: duplicate keys are kept, in order, and each node knows its line. An
/// alias is the node that it stands for, so nodes may be shared.
struct YamlNode {
  enum class Kind { nothing, scalar, list, map };

  Kind kind = Kind::nothing;
  int line = 0;
  std::string text;                                ///< of a scalar
  bool is_plain = false;                           ///< a scalar without quotation marks
  std::vector<YamlPtr> items;                      ///< of a list
  std::vector<std::pair<YamlPtr, YamlPtr>> pairs;  ///< of a map: keys and values
  std::size_t size = 1;                            ///< with all nodes below it, those of aliases too
  std::size_t depth = 1;                           ///< of the deepest node below it, counted from this one

  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_list() const { return kind == Kind::list; }
  bool is_map() const { return kind == Kind::map; }
  /// What a map has under the key, the first time that it is written; nullptr if nothing, or if this is no map.
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

/// The one document of a YAML text. Refused are, besides what is no YAML, more documents than one, control characters,
/// nodes nested deeper than 64, and aliases that stand for more than 10 000 nodes in all or for themselves.
YamlDocument parse_yaml(std::string_view text);

/// What a node is, for messages: its text in quotes, or `a list`, `a map`, `nothing`.
std::string shown(const YamlNode& node);

}  // namespace cohort::parsing
