// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/oldest_sdf.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// Attributes that are the whole value of an element, as in <diffuse rgba="1 0 0 1"/> and <parent link="base"/>.
constexpr std::string_view values[] = {"pose", "rgba", "xyz", "link", "angle", "enabled"};

bool is_whole_value(const XmlNode& node, const ElementRule* rule) {
  return node.children.empty() && node.attributes.size() == 1 &&
         std::ranges::find(values, node.attributes.front().first) != std::end(values) &&
         (rule == nullptr || rule->value.type != ValueType::none);
}

// Returns the name in SDF 1.2.
std::string newer_name(const XmlNode& child, const XmlNode& parent) {
  if (child.name == "origin") return "pose";
  if (child.name == "damping" && parent.name == "link") return "velocity_decay";
  return child.name;
}

std::string newer_name(const std::string& attribute, const XmlNode& element) {
  if (attribute == "rgba" && element.name == "fog") return "color";
  if (attribute == "origin" && element.name == "heightmap") return "pos";
  return attribute;
}

// Converts everything in an element; `rule` is a null pointer if SDF 1.12 does not have it.
bool convert(XmlNode& node, const ElementRule* rule) {
  if (node.name == "plugin") return false;
  bool is_older = false;
  for (XmlNode& child : node.children) {
    child.name = newer_name(child, node);
    const ElementRule* const of_child = rule != nullptr ? rule->child(child.name) : nullptr;
    if (is_whole_value(child, of_child)) {
      child.text = std::exchange(child.attributes, {}).front().second;
      is_older = true;
    } else {
      is_older = convert(child, of_child) || is_older;
    }
  }
  std::erase_if(node.attributes, [&](const auto& attribute) {
    const auto& [name, value] = attribute;
    const bool stays = has_any_prefix(name) || name == "name" || name == "type" || name == "version" ||
                       (rule != nullptr && rule->attribute(name) != nullptr);
    if (!stays) node.children.push_back(element_at(node, newer_name(name, node), value));
    is_older = is_older || !stays;
    return !stays;
  });
  return is_older;
}

}  // namespace

bool make_attributes_elements(XmlNode& sdf) { return convert(sdf, &sdf_rule()); }

}  // namespace cohort::parsing
