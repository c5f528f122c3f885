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

void UrdfVisuals::mend_materials(XmlNode& robot) {
  std::erase_if(robot.children, [&](const XmlNode& child) {
    return child.name == "material" && (value_of(child, "name").empty() || child.children.empty() ||
                                        !materials_.insert(value_of(child, "name")).second);
  });
}

void UrdfVisuals::mend_link(XmlNode& link) const {
  std::erase_if(link.children, [&](XmlNode& child) { return child.name == "visual" && !can_be_shown(child); });
  const UrdfAttribute rgba{"rgba", 4};
  for (XmlNode& visual : link.children)
    if (visual.name == "visual")
      std::erase_if(visual.children, [&](XmlNode& material) {
        if (material.name != "material") return false;
        if (const XmlNode* const color = material.child("color");
            color != nullptr && what_is_wrong(value_of(*color, "rgba"), rgba))
          return true;
        const bool has_own = !material.children.empty();
        if (value_of(material, "name").empty() && has_own) set_attribute(material, "name", "unnamed");
        return !has_own && !materials_.contains(value_of(material, "name"));
      });
}

}  // namespace cohort::parsing
