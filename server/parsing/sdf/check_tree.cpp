// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/check_tree.hpp"

#include <optional>
#include <set>
#include <string>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_angles.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

std::vector<std::string> names_of(const std::vector<AttributeRule>& attributes) {
  std::vector<std::string> names;
  names.reserve(attributes.size());
  for (const AttributeRule& attribute : attributes) names.push_back(attribute.name);
  return names;
}

std::vector<std::string> names_of(const std::vector<ChildRule>& children) {
  std::vector<std::string> names;
  names.reserve(children.size());
  for (const ChildRule& child : children) names.push_back(child.element->name);
  return names;
}

class TreeChecker {
 public:
  void check(XmlNode& node, const ElementRule& rule, const std::string& path);
  std::vector<Problem> take_problems() { return std::move(problems_); }

 private:
  void problem(const XmlNode& node, const std::string& path, std::string message) {
    if (problems_.size() < most_problems) problems_.push_back({node.file->shown, node.line, path, std::move(message)});
  }
  void check_attributes(const XmlNode& node, const ElementRule& rule, const std::string& path);
  void check_value(XmlNode& node, const ElementRule& rule, const std::string& path);
  void check_children(XmlNode& node, const ElementRule& rule, const std::string& path);

  std::vector<Problem> problems_;
};

void TreeChecker::check_attributes(const XmlNode& node, const ElementRule& rule, const std::string& path) {
  std::set<std::string> misspelt;  // attributes that were probably meant
  for (const auto& [name, value] : node.attributes) {
    if (has_any_prefix(name)) continue;
    const AttributeRule* const known = rule.attribute(name);
    if (known == nullptr) {
      const std::vector<std::string> names = names_of(rule.attributes);
      problem(node, path + "/@" + name, "unknown attribute" + suggestion(name, names));
      if (const auto meant = nearest(name, names)) misspelt.insert(*meant);
    } else if (!allows(known->value, value)) {
      problem(node, path, "the attribute '" + name + "' cannot have the value '" + value + "'");
    }
  }
  for (const AttributeRule& attribute : rule.attributes)
    if (attribute.is_required && node.attribute(attribute.name) == nullptr && !misspelt.contains(attribute.name))
      problem(node, path, "missing: the attribute '" + attribute.name + "'");
}

void TreeChecker::check_value(XmlNode& node, const ElementRule& rule, const std::string& path) {
  const bool is_pose = rule.value.type == ValueType::pose;
  if (const auto flaw = flaw_of_angles(node)) {
    problem(node, path, *flaw);
  } else if (is_pose ? !written_pose(node) : !node.text.empty() && !allows(rule.value, node.text)) {
    problem(node, path, "<" + node.name + "> cannot have the value '" + node.text + "'");
    node.text = rule.value.standard;
    if (is_pose) std::erase_if(node.attributes, [](const auto& each) { return each.first != "relative_to"; });
  }
}

void TreeChecker::check_children(XmlNode& node, const ElementRule& rule, const std::string& path) {
  for (XmlNode& child : node.children) {
    if (has_any_prefix(child.name)) continue;
    const std::string child_path = path_below(path, child);
    if (const ElementRule* const of_child = rule.child(child.name))
      check(child, *of_child, child_path);
    else
      problem(child, child_path, "unknown element" + suggestion(child.name, names_of(rule.children)));
  }
  // Other required elements have standard values.
  if (node.name == "joint" && value_of(node, "type") != "ball")
    for (const ChildRule& child : rule.children)
      if (child.presence == Presence::once && node.child(child.element->name) == nullptr)
        problem(node, path, "missing: <" + child.element->name + ">");
}

void TreeChecker::check(XmlNode& node, const ElementRule& rule, const std::string& path) {
  check_attributes(node, rule, path);
  check_value(node, rule, path);
  if (!rule.takes_anything) check_children(node, rule, path);
}

}  // namespace

std::vector<Problem> check_tree(XmlNode& sdf) {
  TreeChecker checker;
  checker.check(sdf, sdf_rule(), sdf.written);
  return checker.take_problems();
}

}  // namespace cohort::parsing
