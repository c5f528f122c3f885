#include "server/parsing/sdf/world_joints.hpp"

#include <algorithm>
#include <optional>
#include <utility>

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

XmlNode breakable_joint_of(const XmlNode& joint, const std::string& parent, const std::string& child) {
  XmlNode ours = element_at(joint, prefixed("breakable_joint"));
  set_attribute(ours, "name", value_of(joint, "name"));
  const auto add_end = [&](const std::string& key, const std::string& name) {
    const auto [object, link] = object_and_link(name);
    ours.children.push_back(element_at(joint, prefixed(key), object));
    if (!link.empty()) ours.children.push_back(element_at(joint, prefixed(key + "_link"), link));
  };
  add_end("first", parent);
  add_end("second", child);
  return ours;
}

XmlNode holding_joint(const XmlNode& joint, const std::string& link) {
  XmlNode held = element_at(joint, "joint");
  held.attributes = {{"name", value_of(joint, "name")}, {"type", "fixed"}};
  held.children = {element_at(joint, "parent", the_world),
                   element_at(joint, "child", link.empty() ? "__model__" : link)};
  return held;
}

// Returns why a joint has no effect.
std::optional<std::string> flaw_of(const XmlNode& joint, const std::string& parent, const std::string& child) {
  if (parent.empty() || child.empty()) return "expected a <parent> and a <child>";
  if (const std::string type = value_of(joint, "type"); type != "fixed")
    return "joints of a world are supported only if they are fixed, not of the type '" + type + "'";
  if (parent == the_world && child == the_world) return "connects the world to itself; expected a model";
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
