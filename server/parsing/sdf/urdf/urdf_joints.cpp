// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"
#include "server/parsing/sdf/urdf/urdf_tree.hpp"

namespace cohort::parsing {
namespace {

void mend_limit(XmlNode& joint, const std::string& path, UrdfNotes& notes) {
  const std::string type = value_of(joint, "type");
  XmlNode* const limit = child_of(joint, "limit");
  if (limit != nullptr) {
    for (const char* const most : {"effort", "velocity"}) {
      if (limit->attribute(most) != nullptr) continue;
      set_attribute(*limit, most, "0");
      notes.pass_over(*limit, path + "/limit", std::string("has no '") + most + "'; it is unlimited");
    }
    return;
  }
  if (type == "revolute") set_attribute(joint, "type", "continuous");
  if (type == "prismatic") {
    XmlNode none = element_at(joint, "limit");
    none.attributes = {{"lower", "-1e16"}, {"upper", "1e16"}, {"effort", "0"}, {"velocity", "0"}};
    joint.children.push_back(std::move(none));
  }
  if (type == "revolute" || type == "prismatic")
    notes.pass_over(joint, path, "has no <limit>, which a " + type + " joint requires; the joint is unlimited");
}

}  // namespace

void name_joints_apart(XmlNode& robot, UrdfNotes& notes) {
  std::set<std::string> taken;
  for (const XmlNode& child : robot.children)
    if (child.name == "link") taken.insert(value_of(child, "name"));
  std::map<std::string, std::string> renamed;
  for (XmlNode& joint : robot.children) {
    const std::string name = value_of(joint, "name");
    if (joint.name != "joint" || !taken.contains(name)) continue;
    std::string other = name + "_joint";
    while (taken.contains(other)) other += "_";
    notes.pass_over(joint, "robot/" + urdf_step(joint),
                    "has the name of a link; the joint is renamed with the suffix '_joint'");
    set_attribute(joint, "name", other);
    renamed.emplace(name, other);
  }
  for (XmlNode& joint : robot.children)
    if (XmlNode* const mimic = joint.name == "joint" ? child_of(joint, "mimic") : nullptr)
      if (const auto leader = renamed.find(value_of(*mimic, "joint")); leader != renamed.end())
        set_attribute(*mimic, "joint", leader->second);
}

void mend_joint(XmlNode& joint, UrdfNotes& notes) {
  const std::string path = "robot/" + urdf_step(joint);
  if (value_of(joint, "type") == "planar") {
    set_attribute(joint, "type", "floating");
    notes.warn(joint, path, "planar joints are not supported; the child moves freely, as with a floating joint");
  }
  XmlNode* const properties = child_of(joint, "joint_properties");
  if (properties != nullptr && joint.child("dynamics") == nullptr) properties->name = "dynamics";
  mend_limit(joint, path, notes);
}

void omit_empty_root(XmlNode& robot) {
  std::set<std::string> children;
  for (const XmlNode& joint : robot.children)
    if (joint.name == "joint") children.insert(urdf_end(joint, "child"));
  std::set<std::string> gone;
  for (const XmlNode& joint : robot.children) {
    const std::string parent = urdf_end(joint, "parent");
    if (joint.name != "joint" || value_of(joint, "type") != "floating" || children.contains(parent)) continue;
    const bool is_needed = std::ranges::any_of(robot.children, [&](const XmlNode& other) {
      return (other.name == "link" && value_of(other, "name") == parent && other.child("inertial") != nullptr) ||
             (other.name == "joint" && &other != &joint && urdf_end(other, "parent") == parent);
    });
    if (!is_needed) gone.insert(parent);
  }
  std::erase_if(robot.children, [&](const XmlNode& node) {
    return (node.name == "link" && gone.contains(value_of(node, "name"))) ||
           (node.name == "joint" && gone.contains(urdf_end(node, "parent")));
  });
}

void omit_lost_mimics(XmlNode& robot, UrdfNotes& notes) {
  std::set<std::string> names;
  for (const XmlNode& joint : robot.children)
    if (joint.name == "joint") names.insert(value_of(joint, "name"));
  for (XmlNode& joint : robot.children) {
    if (joint.name != "joint") continue;
    std::erase_if(joint.children, [&](const XmlNode& child) {
      const std::string leader = value_of(child, "joint");
      if (child.name != "mimic" || leader.empty() || names.contains(leader)) return false;
      notes.warn(child, "robot/" + urdf_step(joint) + "/mimic",
                 "the robot has no joint '" + leader + "'" + suggestion(leader, {names.begin(), names.end()}) +
                     "; <mimic> is ignored");
      return true;
    });
  }
}

}  // namespace cohort::parsing
