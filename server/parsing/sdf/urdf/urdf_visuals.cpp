// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/urdf_visuals.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/urdf_forms.hpp"

namespace cohort::parsing {
namespace {

// An unreadable visual would stop the converter.
bool can_be_shown(XmlNode& visual) {
  XmlNode* const geometry = child_of(visual, "geometry");
  if (geometry == nullptr || geometry->children.size() != 1) return false;
  mend_mesh(*geometry);
  XmlNode& shape = geometry->children.front();
  if (shape.name == "capsule") shape.name = "cylinder";
  if (shape.name == "plane") return false;
  const auto is_right = [](const XmlNode& node, const UrdfForm* form) {
    return form != nullptr && std::ranges::all_of(form->attributes, [&](const UrdfAttribute& attribute) {
             const std::string* const value = node.attribute(attribute.name);
             return value == nullptr ? !attribute.required : !what_is_wrong(*value, attribute);
           });
  };
  const XmlNode* const origin = visual.child("origin");
  return is_right(shape, form_of("geometry", shape.name)) &&
         (origin == nullptr || is_right(*origin, form_of("collision", "origin")));
}

bool has_readable_color(const XmlNode& material) {
  const XmlNode* const color = material.child("color");
  return color == nullptr || !what_is_wrong(value_of(*color, "rgba"), {"rgba", 4});
}

// Returns whether a material has a name and content, so that others can refer to it.
bool is_defined(const XmlNode& material) {
  return !value_of(material, "name").empty() && !material.children.empty() && has_readable_color(material);
}

}  // namespace

void mend_mesh(XmlNode& geometry) {
  XmlNode* const mesh = child_of(geometry, "mesh");
  if (mesh == nullptr) return;
  const std::string scale = value_of(*mesh, "scale");
  const std::vector<std::string_view> parts = words(scale);
  if (parts.size() == 1)
    set_attribute(*mesh, "scale", scale + " " + scale + " " + scale);
  else if (parts.size() > 3)
    set_attribute(*mesh, "scale", std::string(parts[0]) + " " + std::string(parts[1]) + " " + std::string(parts[2]));
}

// As in urdfdom, the definitions of <robot> come first, then those in links in document order.
void UrdfVisuals::mend_materials(XmlNode& robot) {
  std::erase_if(robot.children, [&](const XmlNode& child) {
    return child.name == "material" && (!is_defined(child) || !materials_.insert(value_of(child, "name")).second);
  });
  std::vector<XmlNode> shared;
  for (const XmlNode& link : robot.children)
    for (const XmlNode& visual : link.children)
      if (const XmlNode* const material = visual.child("material");
          link.name == "link" && visual.name == "visual" && material != nullptr && is_defined(*material) &&
          materials_.insert(value_of(*material, "name")).second)
        shared.push_back(*material);
  robot.children.insert(robot.children.end(), shared.begin(), shared.end());
}

void UrdfVisuals::mend_link(XmlNode& link) const {
  std::erase_if(link.children, [&](XmlNode& child) { return child.name == "visual" && !can_be_shown(child); });
  for (XmlNode& visual : link.children)
    if (visual.name == "visual")
      std::erase_if(visual.children, [&](XmlNode& material) {
        if (material.name != "material") return false;
        const bool has_own = !material.children.empty();
        if (has_own && !has_readable_color(material)) return true;
        // A name, even the same for all, would make the first of these materials the one of all.
        if (value_of(material, "name").empty() && has_own) set_attribute(material, "name", "");
        return !has_own && !materials_.contains(value_of(material, "name"));
      });
}

}  // namespace cohort::parsing
