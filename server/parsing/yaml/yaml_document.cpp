// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/yaml/yaml_document.hpp"

#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace cohort::parsing {
namespace {

constexpr std::size_t deepest = 64;
constexpr std::size_t most_from_aliases = 10'000;

struct Refused {
  int line;
  std::string message;
};

bool has_control_character(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n' && c != '\r'; });
}

/// Builds the tree from the events of yaml-cpp, whose nodes have neither positions of aliases nor duplicate keys.
class YamlBuilder : public YAML::EventHandler {
 public:
  YamlPtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    put(make(YamlNode::Kind::nothing, mark), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override;
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(make(YamlNode::Kind::list, mark), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(make(YamlNode::Kind::map, mark), anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    std::shared_ptr<YamlNode> node;
    YAML::anchor_t anchor;
    YamlPtr key;  // key of a map that has no value yet
  };

  static std::shared_ptr<YamlNode> make(YamlNode::Kind kind, const YAML::Mark& mark) {
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->line = mark.line + 1;
    return node;
  }
  void open(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
    if (open_.size() >= deepest)
      throw Refused{node->line, "is nested more than " + std::to_string(deepest) + " levels deep"};
    open_.push_back({std::move(node), anchor, nullptr});
  }
  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    put(std::move(done.node), done.anchor);
  }
  void put(YamlPtr node, YAML::anchor_t anchor);

  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlPtr> anchored_;
  std::size_t from_aliases_ = 0;
  YamlPtr root_;
};

void YamlBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) {
  const auto found = anchored_.find(anchor);
  if (found == anchored_.end()) throw Refused{mark.line + 1, "this alias refers to a value that contains it"};
  const YamlPtr& meant = found->second;
  from_aliases_ += meant->size;
  if (from_aliases_ > most_from_aliases)
    throw Refused{mark.line + 1,
                  "the aliases of this file expand to more than " + std::to_string(most_from_aliases) + " values"};
  if (open_.size() + meant->depth > deepest)
    throw Refused{mark.line + 1, "is nested more than " + std::to_string(deepest) + " levels deep"};
  put(meant, YAML::NullAnchor);
}

void YamlBuilder::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                           const std::string& value) {
  if (has_control_character(value)) throw Refused{mark.line + 1, "this string contains a control character"};
  const auto node = make(YamlNode::Kind::scalar, mark);
  node->text = value;
  node->is_plain = tag == "?";  // notation of yaml-cpp
  put(node, anchor);
}

void YamlBuilder::put(YamlPtr node, YAML::anchor_t anchor) {
  if (anchor != YAML::NullAnchor) anchored_[anchor] = node;
  if (open_.empty()) {
    root_ = std::move(node);
    return;
  }
  Open& parent = open_.back();
  parent.node->size += node->size;
  parent.node->depth = std::max(parent.node->depth, node->depth + 1);
  if (parent.node->is_list())
    parent.node->items.push_back(std::move(node));
  else if (!parent.key)
    parent.key = std::move(node);
  else
    parent.node->pairs.emplace_back(std::exchange(parent.key, nullptr), std::move(node));
}

/// Checks that there is no further document.
class NoMore : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override {
    throw Refused{mark.line + 1, "unexpected second document; a file must contain only one"};
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  const auto found =
      std::ranges::find_if(pairs, [&](const auto& pair) { return pair.first->is_scalar() && pair.first->text == key; });
  return found == pairs.end() ? nullptr : found->second.get();
}

namespace {

// A message of the parser in plain words.
struct Expectation {
  std::string_view said;  ///< how the parser's message begins
  std::string_view text;
};
constexpr Expectation expectations[] = {
    {"illegal map value",
     "unexpected ':', or none in the line above. Expected one 'key: value' per line, all keys with the same "
     "indentation, and quotes around a string that contains ': '"},
    {"illegal map key", "unexpected '?'. Expected 'key: value', or quotes around a string that begins with '?'"},
    {"illegal block entry", "unexpected '- '. Expected each entry of a list on a line of its own"},
    {"end of map not found",
     "wrong indentation, or a key without ':'. Expected 'key: value', indented like the key above"},
    {"end of sequence not found", "wrong indentation. Expected '- ' indented like the entry above"},
    {"end of map flow not found", "'{' is not closed. Expected ',' or '}'"},
    {"end of sequence flow not found", "'[' is not closed. Expected ',' or ']'"},
    {"illegal flow end", "']' or '}' without '[' or '{' before it"},
    {"illegal EOF in scalar", "the quotes around a string are not closed"},
    {"illegal tab", "a tab in the indentation. Expected spaces"},
    {"unknown token", "an unquoted string cannot begin with this character. Expected quotes around the string"},
    {"alias not found after *", "an unquoted string cannot begin with '*'. Expected quotes around the string"},
    {"anchor not found after &", "an unquoted string cannot begin with '&'. Expected quotes around the string"},
    {"the referenced anchor is not defined",
     "no anchor '&' with this name precedes the alias. Expected one, or quotes around a string that begins with '*'"},
    {"unknown escape character",
     "unknown escape after a backslash. Expected single quotes around a string with backslashes"},
};

std::string in_plain_words(const YAML::Exception& error) {
  const auto found =
      std::ranges::find_if(expectations, [&](const Expectation& each) { return error.msg.starts_with(each.said); });
  const std::string text = found == std::end(expectations) ? error.msg : std::string(found->text);
  return error.mark.is_null() ? text : text + " (column " + std::to_string(error.mark.column + 1) + ")";
}

}  // namespace

YamlDocument parse_yaml(std::string_view text) {
  YamlDocument document;
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    YamlBuilder tree;
    if (!parser.HandleNextDocument(tree) || !tree.root()) {
      document.error = {0, "this file is empty"};
      return document;
    }
    NoMore no_more;
    parser.HandleNextDocument(no_more);
    document.root = tree.root();
  } catch (const Refused& refused) {
    document.error = {refused.line, refused.message};
  } catch (const YAML::Exception& error) {
    document.error = {error.mark.is_null() ? 0 : error.mark.line + 1, "not YAML: " + in_plain_words(error)};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    document.error = {0, std::string("cannot be read: ") + error.what()};
  }
  return document;
}

std::string shown(const YamlNode& node) {
  constexpr std::size_t most = 60;  // a whole file may be one scalar
  switch (node.kind) {
    case YamlNode::Kind::scalar:
      return "'" + (node.text.size() <= most ? node.text : node.text.substr(0, most) + "…") + "'";
    case YamlNode::Kind::list: return "a list";
    case YamlNode::Kind::map: return "a map";
    case YamlNode::Kind::nothing: break;
  }
  return "nothing";
}

}  // namespace cohort::parsing
