// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/yaml/setting.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

using Steps = std::span<const std::string>;

[[noreturn]] void refuse(std::string_view text, const std::string& problem) {
  throw std::invalid_argument("'" + std::string(text) + "' " + problem + ", expected PATH=VALUE, such as " +
                              "teams.swarm.parameters.gain=2");
}

std::vector<std::string> steps_of(std::string_view path, std::string_view text) {
  std::vector<std::string> steps(1);
  bool is_quoted = false;
  for (const char c : path) {
    if (c == '"')
      is_quoted = !is_quoted;
    else if (c == '.' && !is_quoted)
      steps.emplace_back();
    else
      steps.back() += c;
  }
  if (is_quoted) refuse(text, "has a quotation mark without another one");
  if (std::ranges::any_of(steps, &std::string::empty)) refuse(text, "has a path with an empty step");
  return steps;
}

// Returns where the path ends: the first '=' outside of quotation marks.
std::size_t end_of_path(std::string_view text) {
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') is_quoted = !is_quoted;
    if (text[i] == '=' && !is_quoted) return i;
  }
  refuse(text, "has no '='");
}

std::shared_ptr<YamlNode> node_at(YamlNode::Kind kind, int line) {
  auto node = std::make_shared<YamlNode>();
  node->kind = kind;
  node->line = line;
  return node;
}

// Counts the nodes below a node again, after one of them has changed.
YamlPtr counted(std::shared_ptr<YamlNode> node) {
  node->size = 1;
  node->depth = 1;
  const auto count = [&](const YamlNode& below) {
    node->size += below.size;
    node->depth = std::max(node->depth, below.depth + 1);
  };
  for (const YamlPtr& item : node->items) count(*item);
  for (const auto& [key, value] : node->pairs) {
    count(*key);
    count(*value);
  }
  return node;
}

YamlPtr at_line(const YamlNode& value, int line) {
  auto moved = std::make_shared<YamlNode>(value);
  moved->line = line;
  for (YamlPtr& item : moved->items) item = at_line(*item, line);
  for (auto& [key, of_key] : moved->pairs) {
    key = at_line(*key, line);
    of_key = at_line(*of_key, line);
  }
  return moved;
}

YamlPtr key_node(const std::string& key, int line) {
  auto node = node_at(YamlNode::Kind::scalar, line);
  node->text = key;
  return node;
}

class Setter {
 public:
  Setter(const Setting& setting, const YamlReport& report) : setting_(setting), report_(report) {}

  // Returns null after a problem. `done`: the number of steps that lead to the node.
  YamlPtr set(const YamlPtr& node, std::size_t done) const {
    if (done == setting_.path.size()) return at_line(*setting_.value, node->line);
    switch (node->kind) {
      case YamlNode::Kind::nothing: return document_of(rest(done), setting_.value, node->line);
      case YamlNode::Kind::map: return set_in_map(*node, done);
      case YamlNode::Kind::list: return set_in_list(*node, done);
      case YamlNode::Kind::scalar: break;
    }
    report_.problem(*node, setting_.path_text(), "cannot be set, since " + shown(*node) + " has no keys");
    return nullptr;
  }

 private:
  Steps rest(std::size_t done) const { return Steps(setting_.path).subspan(done); }

  YamlPtr set_in_map(const YamlNode& map, std::size_t done) const {
    auto changed = std::make_shared<YamlNode>(map);
    const std::string& key = setting_.path[done];
    const auto found = std::ranges::find_if(
        changed->pairs, [&](const auto& pair) { return pair.first->is_scalar() && pair.first->text == key; });
    if (found == changed->pairs.end()) {
      changed->pairs.emplace_back(key_node(key, map.line), document_of(rest(done + 1), setting_.value, map.line));
      return counted(std::move(changed));
    }
    found->second = set(found->second, done + 1);
    return found->second ? counted(std::move(changed)) : nullptr;
  }

  YamlPtr set_in_list(const YamlNode& list, std::size_t done) const {
    const std::optional<std::size_t> place = place_of(list, setting_.path[done]);
    if (!place) return nullptr;
    auto changed = std::make_shared<YamlNode>(list);
    changed->items[*place] = set(list.items[*place], done + 1);
    return changed->items[*place] ? counted(std::move(changed)) : nullptr;
  }

  std::optional<std::size_t> place_of(const YamlNode& list, const std::string& step) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      const YamlNode* const name = list.items[i]->find("name");
      if (name == nullptr) continue;
      if (name->text == step) return i;
      names.push_back(name->text);
    }
    if (const auto index = parse_whole(step); index && *index < list.items.size())
      return static_cast<std::size_t>(*index);
    std::string known = suggestion(step, names);
    if (names.empty()) known = "; the list has " + std::to_string(list.items.size()) + " items, counted from 0";
    report_.problem(list, setting_.path_text(), "cannot be set, since there is no item '" + step + "'" + known);
    return std::nullopt;
  }

  const Setting& setting_;
  const YamlReport& report_;
};

}  // namespace

std::string Setting::path_text() const {
  std::string text;
  for (const std::string& step : path) text += (text.empty() ? "" : ".") + step;
  return text;
}

Setting parse_setting(std::string_view text) {
  const std::size_t end = end_of_path(text);
  Setting setting{std::string(text), steps_of(text.substr(0, end), text), nullptr};
  const YamlDocument value = parse_yaml(text.substr(end + 1));
  if (value.error) refuse(text, "has a value that is not YAML (" + value.error->message + ")");
  if (value.root->kind == YamlNode::Kind::nothing) refuse(text, "has no value");
  setting.value = value.root;
  return setting;
}

YamlPtr with_setting(const YamlPtr& document, const Setting& setting, const YamlReport& report) {
  YamlPtr changed = Setter(setting, report).set(document, 0);
  return changed ? changed : document;
}

YamlPtr document_of(Steps path, const YamlPtr& value, int line) {
  YamlPtr node = at_line(*value, line);
  for (std::size_t i = path.size(); i-- > 0;) {
    auto map = node_at(YamlNode::Kind::map, line);
    map->pairs.emplace_back(key_node(path[i], line), std::move(node));
    node = counted(std::move(map));
  }
  return node;
}

}  // namespace cohort::parsing
