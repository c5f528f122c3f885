// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/missing_effects.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "server/parsing/sdf/schema/sdf_rules.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/tree/counted_warnings.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// Returns whether an element and everything below it could as well not be written.
bool is_standard(const XmlNode& node, const ElementRule& rule) {
  const bool has_value = rule.value.type != ValueType::none;
  if (!has_value && node.children.empty()) return false;
  if (has_value && !is_standard(rule.value, node.text)) return false;
  return std::ranges::all_of(node.attributes,
                             [&](const auto& each) {
                               const AttributeRule* const attribute = rule.attribute(each.first);
                               return attribute != nullptr && is_standard(attribute->value, each.second);
                             }) &&
         std::ranges::all_of(node.children, [&](const XmlNode& child) {
           const ElementRule* const of_child = rule.child(child.name);
           return of_child != nullptr && is_standard(child, *of_child);
         });
}

class MissingEffects {
 public:
  void look_below(const XmlNode& node, const ElementRule& rule, const std::string& path);
  void tell(std::vector<Problem>& warnings) const;

 private:
  template <class Rule>
  void note(const Rule& rule, const std::string& name, const XmlNode& where, const std::string& path);

  CountedWarnings missing_;
  std::optional<Problem> first_;    // the position of the first one without any effect
  std::vector<std::string> names_;  // all names without any effect
};

template <class Rule>
void MissingEffects::note(const Rule& rule, const std::string& name, const XmlNode& where, const std::string& path) {
  const Problem place{where.file->shown, where.line, path, ""};
  if (rule.effect == Effect::missing) missing_.add(place, name + " is not supported and is ignored" + rule.remark);
  if (rule.effect != Effect::none) return;
  if (!first_) first_ = place;
  if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
}

void MissingEffects::look_below(const XmlNode& node, const ElementRule& rule, const std::string& path) {
  for (const auto& [name, value] : node.attributes) {
    const AttributeRule* const attribute = rule.attribute(name);
    if (attribute != nullptr && !is_standard(attribute->value, value))
      note(*attribute, "'" + name + "' of <" + node.name + ">", node, path);
  }
  for (const XmlNode& child : node.children) {
    const ChildRule* const of_child = rule.child_rule(child.name);
    if (of_child == nullptr) continue;
    const std::string child_path = path_below(path, child);
    if (of_child->effect == Effect::full)
      look_below(child, *of_child->element, child_path);
    else if (!is_standard(child, *of_child->element))
      note(*of_child, "<" + child.name + ">", child, child_path);
  }
}

void MissingEffects::tell(std::vector<Problem>& warnings) const {
  missing_.tell(warnings);
  if (!first_) return;
  std::string names;
  for (const std::string& name : names_) names += (names.empty() ? "" : ", ") + name;
  warnings.push_back(*first_);
  warnings.back().message = "no effect in Cohort: " + names;
}

}  // namespace

void tell_of_missing_effects(const XmlNode& tree, std::vector<Problem>& warnings) {
  MissingEffects missing;
  missing.look_below(tree, sdf_rule(), "");
  missing.tell(warnings);
}

}  // namespace cohort::parsing
