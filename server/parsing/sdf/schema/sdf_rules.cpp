// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/sdf_rules.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

ValueType type_of(std::string_view word) {
  constexpr std::pair<std::string_view, ValueType> types[] = {
      {"text", ValueType::text},   {"flag", ValueType::flag},       {"integer", ValueType::integer},
      {"count", ValueType::count}, {"real", ValueType::real},       {"vector2", ValueType::vector2},
      {"color", ValueType::color}, {"vector3", ValueType::vector3}, {"time", ValueType::time},
      {"pose", ValueType::pose}};
  const auto found = std::ranges::find(types, word, [](const auto& type) { return type.first; });
  return found == std::end(types) ? ValueType::none : found->second;
}

Presence presence_of(std::string_view word) {
  switch (word.front()) {
    case '1': return Presence::once;
    case '?': return Presence::at_most_once;
    case '*': return Presence::any;
    case '+': return Presence::at_least_once;
    case '-': return Presence::deprecated;
    default: throw std::logic_error("no presence in the rules of SDF: " + std::string(word));
  }
}

std::optional<Effect> effect_of(std::string_view word) {
  if (word.size() > 1 && word[1] != '"') return std::nullopt;
  switch (word.front()) {
    case '-': return Effect::appearance;
    case '~': return Effect::none;
    case 'x': return Effect::missing;
    case '!': return Effect::told;
    default: return std::nullopt;
  }
}

// Sets the effect and the remark of an element or an attribute.
template <class Rule>
void set_effect(std::string_view word, Rule& rule) {
  rule.effect = effect_of(word).value();
  if (word.size() > 2) rule.remark = word.substr(2, word.size() - 3);
}

/// Reads the text of the rules.
class RuleReader {
 public:
  RuleReader() {
    for (const char* const text : {rules_of_worlds, rules_of_models, rules_of_sensors}) read(text);
    for (const auto& [parent, place, name] : references_) parent->children[place].element = &rule(name);
  }

  const ElementRule& rule(std::string_view name) const { return *named_.at(std::string(name)); }

 private:
  struct Reference {
    ElementRule* parent;
    std::size_t place;  ///< among the children
    std::string_view name;
  };

  void read(std::string_view text);
  void read_line(std::string_view line, std::size_t level);
  void read_rest(ElementRule& rule, ChildRule& place, std::string_view rest);

  std::deque<ElementRule> rules_;
  std::map<std::string, ElementRule*> named_;
  std::vector<Reference> references_;
  std::vector<ElementRule*> open_;  // the last element of each level
};

// Removes the first word from `rest`. A word ends at a space that is not between quotation marks.
std::string_view next_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  std::size_t end = 0;
  for (bool is_quoted = false; end < rest.size() && (is_quoted || rest[end] != ' '); ++end)
    if (rest[end] == '"') is_quoted = !is_quoted;
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

void RuleReader::read(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent != std::string_view::npos) read_line(line.substr(indent), indent / 2);
  }
}

void RuleReader::read_line(std::string_view line, std::size_t level) {
  ChildRule unplaced{};
  if (line.starts_with('@')) return read_rest(*open_.back(), unplaced, line);
  open_.resize(level);
  ElementRule* const parent = level == 0 ? nullptr : open_.back();
  ChildRule& place = parent != nullptr ? parent->children.emplace_back() : unplaced;
  std::string_view name = next_word(line);
  place.presence = presence_of(next_word(line));
  if (parent != nullptr && name.starts_with('[')) {
    name = name.substr(1, name.size() - 2);
    references_.push_back({parent, parent->children.size() - 1, name});
    if (!line.empty()) set_effect(next_word(line), place);
    return;
  }
  ElementRule& rule = rules_.emplace_back();
  rule.name = name;
  place.element = &rule;
  read_rest(rule, place, line);
  open_.push_back(&rule);
  rule.is_shared = parent == nullptr;
  if (rule.is_shared) named_.emplace(rule.name, &rule);
}

void RuleReader::read_rest(ElementRule& rule, ChildRule& place, std::string_view rest) {
  ValueRule* value = &rule.value;
  AttributeRule* attribute = nullptr;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    if (word == "...") {
      rule.takes_anything = true;
    } else if (word.starts_with('@')) {
      word.remove_prefix(1);
      attribute = &rule.attributes.emplace_back();
      attribute->is_required = word.ends_with('!');
      attribute->name = word.substr(0, word.size() - (attribute->is_required ? 1 : 0));
      value = &attribute->value;
    } else if (effect_of(word)) {
      attribute != nullptr ? set_effect(word, *attribute) : set_effect(word, place);
    } else if (word.starts_with('"')) {
      value->standard = word.substr(1, word.size() - 2);
    } else if (word.starts_with(">=")) {
      value->least = parse_real(word.substr(2)).value();
    } else if (word.starts_with("<=")) {
      value->greatest = parse_real(word.substr(2)).value();
    } else {
      value->type = type_of(word);
      if (value->type == ValueType::none) throw std::logic_error("no type in the rules of SDF: " + std::string(word));
    }
  }
}

}  // namespace

const ElementRule& sdf_rule() {
  static const RuleReader reader;
  return reader.rule("sdf");
}

std::size_t count_of_numbers(ValueType type) {
  switch (type) {
    case ValueType::integer:
    case ValueType::count:
    case ValueType::real: return 1;
    case ValueType::vector2: return 2;
    case ValueType::vector3: return 3;
    default: return 0;
  }
}

const ElementRule* ElementRule::child(std::string_view child_name) const {
  const ChildRule* const found = child_rule(child_name);
  return found == nullptr ? nullptr : found->element;
}

const ChildRule* ElementRule::child_rule(std::string_view child_name) const {
  const auto found = std::ranges::find(children, child_name,
                                       [](const ChildRule& child) -> std::string_view { return child.element->name; });
  return found == children.end() ? nullptr : &*found;
}

const AttributeRule* ElementRule::attribute(std::string_view attribute_name) const {
  const auto found = std::ranges::find(attributes, attribute_name, &AttributeRule::name);
  return found == attributes.end() ? nullptr : &*found;
}

}  // namespace cohort::parsing
