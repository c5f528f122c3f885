// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/world_joints.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* the_world = "world";

// Returns the object and its link for a name such as `arm::hand::palm`.
std::pair<std::string, std::string> object_and_link(const std::string& name) {
  const std::size_t end = name.find("::");
  return {name.substr(0, end), end == std::string::npos ? "" : name.substr(end + 2)};
}

// Returns the element to which a frame of the world is attached, which is no frame of the world. Frames that refer to
// each other in a cycle are reported elsewhere.
std::string attached(const XmlNode& world, std::string name) {
  for (std::size_t steps = 0; steps < world.children.size(); ++steps) {
    const auto frame = std::ranges::find_if(
        world.children, [&](const XmlNode& child) { return child.name == "frame" && name_of(child) == name; });
    if (frame == world.children.end()) return name;
    const std::string to = value_of(*frame, "attached_to");
    name = to.empty() ? the_world : to;
  }
  return name;
}

// Returns the type of breakable joint that is like a joint between two models; empty if there is none.
std::string breakable_type_of(const XmlNode& joint) {
  const std::string type = value_of(joint, "type");
  if (type == "continuous") return "revolute";
  return type == "fixed" || type == "revolute" || type == "ball" ? type : "";
}

// The frame of a joint is by default in that of its child, so that the child comes first.
XmlNode breakable_joint_of(const XmlNode& joint, const std::string& parent, const std::string& child) {
  XmlNode ours = element_at(joint, prefixed("breakable_joint"));
  set_attribute(ours, "name", value_of(joint, "name"));
  const auto add_end = [&](const std::string& key, const std::string& name) {
    const auto [object, link] = object_and_link(name);
    ours.children.push_back(element_at(joint, prefixed(key), object));
    if (!link.empty()) ours.children.push_back(element_at(joint, prefixed(key + "_link"), link));
  };
  add_end("first", child);
  add_end("second", parent);
  const std::string type = breakable_type_of(joint);
  if (type == "fixed") return ours;
  const auto add_value = [&](const std::string& key, const XmlNode* from, const std::string& otherwise) {
    const bool is_given = from != nullptr && !from->text.empty();
    ours.children.push_back(element_at(is_given ? *from : joint, prefixed(key), is_given ? from->text : otherwise));
  };
  add_value("type", nullptr, type);
  add_value("pose", joint.child("pose"), "0 0 0 0 0 0");
  const XmlNode* const axis = joint.child("axis");
  if (type == "revolute") add_value("axis", axis != nullptr ? axis->child("xyz") : nullptr, "0 0 1");
  const XmlNode* const dynamics = axis != nullptr ? axis->child("dynamics") : nullptr;
  add_value("damping", dynamics != nullptr ? dynamics->child("damping") : nullptr, "0");
  return ours;
}

// Returns the joint as one of its model. It holds the model if it is fixed, so that its pose does not matter.
XmlNode holding_joint(const XmlNode& joint, const std::string& link) {
  XmlNode held = element_at(joint, "joint");
  held.attributes = {{"name", value_of(joint, "name")}, {"type", value_of(joint, "type")}};
  held.children = {element_at(joint, "parent", the_world),
                   element_at(joint, "child", link.empty() ? "__model__" : link)};
  if (value_of(joint, "type") == "fixed") return held;
  for (const XmlNode& child : joint.children)
    if (child.name != "parent" && child.name != "child") held.children.push_back(child);
  return held;
}

// Returns the first attribute that names a frame, which could be any of the world; empty if there is none.
std::string frame_named_in(const XmlNode& node) {
  for (const char* const attribute : {"relative_to", "expressed_in"})
    if (const std::string* const frame = node.attribute(attribute); frame != nullptr && !frame->empty())
      return std::string(attribute) + "=\"" + *frame + "\"";
  for (const XmlNode& child : node.children)
    if (std::string named = frame_named_in(child); !named.empty()) return named;
  return "";
}

// Returns what a hinge between two models would need, but does not have.
std::string missing_in_hinge(const XmlNode& joint) {
  const XmlNode* const axis = joint.child("axis");
  if (axis == nullptr || value_of(joint, "type") == "fixed") return "";
  const auto number = [&](const XmlNode* node, const char* name) {
    const XmlNode* const value = node != nullptr ? node->child(name) : nullptr;
    return value != nullptr ? parse_real(value->text).value_or(0.0) : 0.0;
  };
  constexpr double any_angle = 1e16;
  const XmlNode* const limit = axis->child("limit");
  for (const char* const name : {"lower", "upper"})
    if (limit != nullptr && limit->child(name) != nullptr && std::abs(number(limit, name)) < any_angle) return "limits";
  for (const char* const name : {"friction", "spring_stiffness"})
    if (number(axis->child("dynamics"), name) != 0.0) return "friction or spring";
  return "";
}

// Returns why a joint has no effect.
std::optional<std::string> flaw_of(const XmlNode& joint, const std::string& parent, const std::string& child) {
  if (parent.empty() || child.empty()) return "expected a <parent> and a <child>";
  if (parent == the_world && child == the_world) return "connects the world to itself; expected a model";
  const std::string type = value_of(joint, "type");
  if (type == "fixed") return std::nullopt;
  if (child == the_world) return "expected the world as its parent, unless the joint is fixed";
  if (child != joint.child("child")->text) return "expected a model or a link as its child, unless the joint is fixed";
  if (parent != the_world && breakable_type_of(joint).empty())
    return "joints between two models are supported only if they are fixed, revolute, continuous or ball, not of the "
           "type '" +
           type + "'";
  if (const std::string frame = frame_named_in(joint); !frame.empty())
    return frame + " is supported only in joints of a model";
  return std::nullopt;
}

}  // namespace

HoldingJoints take_world_joints(XmlNode& world, const std::string& path, std::vector<Problem>& warnings) {
  HoldingJoints holding;
  std::vector<XmlNode> breakable;
  for (const XmlNode& joint : world.children) {
    if (joint.name != "joint") continue;
    const auto end = [&](const char* name) {
      const XmlNode* const element = joint.child(name);
      return element != nullptr ? attached(world, element->text) : "";
    };
    const std::string parent = end("parent");
    const std::string child = end("child");
    if (const auto flaw = flaw_of(joint, parent, child)) {
      warnings.push_back(
          {joint.file->shown, joint.line, path + "/" + step_of(joint), *flaw + "; the joint is ignored"});
    } else if (parent != the_world && child != the_world) {
      breakable.push_back(breakable_joint_of(joint, parent, child));
      if (const std::string missing = missing_in_hinge(joint); !missing.empty())
        warnings.push_back({joint.file->shown, joint.line, path + "/" + step_of(joint),
                            "a joint between two models has no " + missing + ", and turns freely"});
    } else {
      const auto [object, link] = object_and_link(parent == the_world ? child : parent);
      holding.emplace(object, holding_joint(joint, link));
    }
  }
  std::erase_if(world.children, [](const XmlNode& child) { return child.name == "joint"; });
  std::ranges::move(breakable, std::back_inserter(world.children));
  return holding;
}

}  // namespace cohort::parsing
