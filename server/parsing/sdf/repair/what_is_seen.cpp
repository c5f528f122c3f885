// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/what_is_seen.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "server/parsing/sdf/schema/sdf_angles.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

const ElementSchema& schema_of_visuals() {
  static const ElementSchema schema = ElementSchema::root().child("model").child("link").child("visual");
  return schema;
}

bool can_be_read(const XmlNode& node, const ElementSchema& schema) {
  const bool is_right = node.name == "pose" ? written_pose(node).has_value() && !flaw_of_angles(node)
                                            : node.text.empty() || schema.can_have(node.text);
  if (!is_right) return false;
  return std::ranges::all_of(node.children,
                             [&](const XmlNode& child) { return can_be_read(child, schema.child(child.name)); });
}

// Removes everything else.
bool has_albedo_map(XmlNode& pbr) {
  const auto keep_first = [](XmlNode& node, const char* name) {
    bool is_kept = false;
    std::erase_if(node.children,
                  [&](const XmlNode& child) { return child.name != name || std::exchange(is_kept, true); });
    return is_kept;
  };
  pbr.text.clear();
  XmlNode* const workflow = keep_first(pbr, "metal") ? child_of(pbr, "metal") : nullptr;
  if (workflow == nullptr || !keep_first(*workflow, "albedo_map")) return false;
  workflow->text.clear();
  XmlNode& map = *child_of(*workflow, "albedo_map");
  map.children.clear();
  return !map.text.empty();
}

bool is_shown(XmlNode& visual) {
  const ElementSchema& schema = schema_of_visuals();
  std::erase_if(visual.children, [](const XmlNode& child) {
    return child.name != "pose" && child.name != "geometry" && child.name != "material" && child.name != "transparency";
  });
  if (XmlNode* const material = child_of(visual, "material")) {
    std::erase_if(material->children, [&](XmlNode& child) {
      if (child.name == "pbr") return !has_albedo_map(child);
      return child.name != "diffuse" || !can_be_read(child, schema.child("material").child("diffuse"));
    });
  }
  const XmlNode* const geometry = visual.child("geometry");
  return geometry != nullptr && geometry->children.size() == 1 && can_be_read(visual, schema);
}

void keep_visuals(XmlNode& link) {
  std::set<std::string> names;
  std::erase_if(link.children, [](XmlNode& child) { return child.name == "visual" && !is_shown(child); });
  for (XmlNode& visual : link.children) {
    if (visual.name != "visual") continue;
    std::string name = value_of(visual, "name").empty() ? "visual" : value_of(visual, "name");
    while (!names.insert(name).second) name += "_";
    set_attribute(visual, "name", name);
  }
}

}  // namespace

void keep_what_is_shown(XmlNode& tree) {
  if (tree.name == "link") return keep_visuals(tree);
  if (tree.name == "world")
    std::erase_if(tree.children, [](const XmlNode& child) { return child.name == "gui" || child.name == "scene"; });
  for (XmlNode& child : tree.children)
    if (child.name == "world" || child.name == "model" || child.name == "link") keep_what_is_shown(child);
}

}  // namespace cohort::parsing
