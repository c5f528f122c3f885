#include "server/parsing/sdf/urdf/urdf_rest.hpp"

#include <algorithm>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// Returns the link, and the index of its collision, for a name such as `axle_fixed_joint_lump__wheel_collision_1`.
std::pair<std::string, std::size_t> source_of_collision(std::string name) {
  constexpr std::string_view lump = "_fixed_joint_lump__";
  if (const std::size_t at = name.rfind(lump); at != std::string::npos) name.erase(0, at + lump.size());
  constexpr std::string_view kind = "_collision";
  const std::size_t end = name.rfind(kind);
  if (end == std::string::npos) return {name, 0};
  const std::string_view number = std::string_view(name).substr(end + kind.size());
  const auto place = number.starts_with('_') ? parse_whole(number.substr(1)) : std::nullopt;
  return {name.substr(0, end), place.value_or(0)};
}

// Existing elements of `into` stay.
void merge_into(XmlNode& into, const XmlNode& from) {
  for (const XmlNode& child : from.children) {
    XmlNode* const own = child_of(into, child.name);
    if (own == nullptr)
      into.children.push_back(child);
    else
      merge_into(*own, child);
  }
}

}  // namespace

void add_rest(const UrdfRest& rest, XmlNode& model) {
  for (XmlNode& link : model.children) {
    if (link.name != "link") continue;
    for (XmlNode& collision : link.children) {
      if (collision.name != "collision") continue;
      const auto source = source_of_collision(value_of(collision, "name"));
      if (const auto surface = rest.surfaces.find(source.first); surface != rest.surfaces.end()) {
        XmlNode* own = child_of(collision, "surface");
        if (own == nullptr) own = &collision.children.emplace_back(element_at(collision, "surface"));
        merge_into(*own, surface->second);
      }
      XmlNode* const geometry = child_of(collision, "geometry");
      XmlNode* const cylinder = geometry != nullptr ? child_of(*geometry, "cylinder") : nullptr;
      if (cylinder != nullptr && rest.capsules.contains(source)) cylinder->name = "capsule";
      const auto plane = rest.planes.find(source);
      if (geometry != nullptr && plane != rest.planes.end()) {
        XmlNode shape = element_at(*geometry, "plane");
        shape.children = {element_at(shape, "normal", plane->second)};
        geometry->children = {std::move(shape)};
      }
    }
    if (XmlNode* const inertial = child_of(link, "inertial");
        inertial != nullptr && rest.weightless.contains(value_of(link, "name")))
      inertial->children = {element_at(*inertial, "mass", "0")};
  }
  for (XmlNode& joint : model.children)
    if (joint.name == "joint" && rest.balls.contains(value_of(joint, "name"))) {
      set_attribute(joint, "type", "ball");
      std::erase_if(joint.children, [](const XmlNode& child) { return child.name == "axis"; });
    }
  const bool has_joints =
      std::ranges::any_of(model.children, [](const XmlNode& child) { return child.name == "joint"; });
  if (!rest.planes.empty() && !rest.held.empty() && !has_joints) {  // ground
    model.children.push_back(element_at(model, "static", "true"));
    return;
  }
  for (const std::string& name : rest.let_go) {
    const auto joint = std::ranges::find_if(
        model.children, [&](const XmlNode& child) { return child.name == "joint" && value_of(child, "name") == name; });
    if (joint == model.children.end()) continue;
    const XmlNode* const child = joint->child("child");
    const XmlNode* const parent = joint->child("parent");
    const XmlNode* const written = joint->child("pose");
    XmlNode pose = written != nullptr ? *written : element_at(*joint, "pose", "0 0 0 0 0 0");
    if (value_of(pose, "relative_to").empty() && parent != nullptr) set_attribute(pose, "relative_to", parent->text);
    for (XmlNode& link : model.children) {
      if (link.name != "link" || child == nullptr || value_of(link, "name") != child->text) continue;
      std::erase_if(link.children, [](const XmlNode& part) { return part.name == "pose"; });
      link.children.push_back(pose);
    }
    model.children.erase(joint);
  }
  if (rest.held.empty()) return;
  XmlNode joint = element_at(model, "joint");
  joint.attributes = {{"name", rest.held + "_to_world"}, {"type", "fixed"}};
  joint.children = {element_at(model, "parent", "world"), element_at(model, "child", rest.held)};
  model.children.push_back(std::move(joint));
}

}  // namespace cohort::parsing
