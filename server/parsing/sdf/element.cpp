// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/element.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

std::string with_single_spaces(const std::string& text) {
  std::string joined;
  for (const std::string_view word : words(text)) (joined += joined.empty() ? "" : " ") += word;
  return joined;
}

// Returns the text if SDF allows it, otherwise the standard value.
std::string valid_text(const std::string& text, const ValueRule& rule) {
  return !text.empty() && allows(rule, text) ? text : rule.standard;
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view word : words(text)) numbers.push_back(leading_number(word).value_or(0.0));
  return numbers;
}

double real_in(const std::string& text, const ValueRule& rule) {
  const std::vector<double> numbers = numbers_in(valid_text(text, rule));
  return numbers.empty() ? 0.0 : numbers.front();
}

Eigen::Vector3d vector_in(const std::string& text, const ValueRule& rule) {
  std::vector<double> numbers = numbers_in(valid_text(text, rule));
  numbers.resize(3);
  return {numbers[0], numbers[1], numbers[2]};
}

const ValueRule& no_rule() {
  static const ValueRule none{ValueType::text, "", -std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};
  return none;
}

}  // namespace

const Element* Element::child(std::string_view name) const {
  const auto found = std::ranges::find(children_, name, &Element::name);
  return found == children_.end() ? nullptr : *found;
}

const Element* Element::next_alike() const {
  if (parent_ == nullptr) return nullptr;
  const auto own = std::ranges::find(parent_->children_, this);
  const auto found = std::find_if(own + 1, parent_->children_.end(),
                                  [&](const Element* sibling) { return sibling->name() == name(); });
  return found == parent_->children_.end() ? nullptr : *found;
}

std::string Element::attribute(std::string_view name) const {
  if (const std::string* const value = node_.attribute(name)) return *value;
  const AttributeRule* const rule = rule_ != nullptr ? rule_->attribute(name) : nullptr;
  return rule != nullptr ? rule->value.standard : std::string();
}

std::string Element::text() const {
  if (is_set() || rule_ == nullptr) return with_single_spaces(node_.text);
  return rule_->value.standard;
}

double Element::real() const { return real_in(node_.text, rule_ != nullptr ? rule_->value : no_rule()); }

bool Element::flag() const {
  return is_true(trimmed(valid_text(node_.text, rule_ != nullptr ? rule_->value : no_rule())));
}

unsigned Element::count() const {
  return static_cast<unsigned>(leading_whole(valid_text(node_.text, rule_ != nullptr ? rule_->value : no_rule())));
}

Eigen::Vector3d Element::vector() const { return vector_in(node_.text, rule_ != nullptr ? rule_->value : no_rule()); }

Eigen::Vector4d Element::color() const {
  std::vector<double> numbers = numbers_in(valid_text(node_.text, rule_ != nullptr ? rule_->value : no_rule()));
  numbers.resize(4, 1.0);
  for (double& number : numbers) number = static_cast<double>(static_cast<float>(number));
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

const ValueRule& Element::value_rule(std::string_view child) const {
  const ElementRule* const rule = rule_ != nullptr ? rule_->child(child) : nullptr;
  return rule != nullptr ? rule->value : no_rule();
}

std::string Element::text(std::string_view name) const {
  const Element* const found = child(name);
  return found != nullptr ? found->text() : value_rule(name).standard;
}

double Element::real(std::string_view name) const {
  const Element* const found = child(name);
  return found != nullptr ? found->real() : real_in("", value_rule(name));
}

bool Element::flag(std::string_view name) const {
  const Element* const found = child(name);
  return found != nullptr ? found->flag() : is_true(value_rule(name).standard);
}

Eigen::Vector3d Element::vector(std::string_view name) const {
  const Element* const found = child(name);
  return found != nullptr ? found->vector() : vector_in("", value_rule(name));
}

const Element* ElementTree::add(const XmlNode& node, const ElementRule* rule, const Element* parent) {
  Element& element = elements_.emplace_back(node, rule, parent);
  element.children_.reserve(node.children.size());
  const bool is_known = rule != nullptr && !rule->takes_anything;
  for (const XmlNode& child : node.children) {
    element.children_.push_back(add(child, is_known ? rule->child(child.name) : nullptr, &element));
  }
  return &element;
}

const Element* find(const Element* element, std::initializer_list<const char*> path) {
  for (const char* const name : path) {
    if (element == nullptr) return nullptr;
    element = element->child(name);
  }
  return element;
}

std::vector<const Element*> children_of(const Element& parent, std::string_view name) {
  std::vector<const Element*> found;
  std::ranges::copy_if(parent.children(), std::back_inserter(found),
                       [&](const Element* child) { return child->name() == name; });
  return found;
}

}  // namespace cohort::parsing
