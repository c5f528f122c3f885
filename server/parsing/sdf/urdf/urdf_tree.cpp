// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/urdf_tree.hpp"

#include <algorithm>
#include <iterator>

#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"
#include "server/parsing/sdf/urdf/urdf_pose.hpp"

namespace cohort::parsing {

const UrdfLink& UrdfLink::carrier() const { return is_merged ? parent->carrier() : *this; }

Pose UrdfLink::in_carrier(Pose pose) const {
  for (const UrdfLink* link = this; link->is_merged; link = link->parent) pose = urdf_origin(*link->joint) * pose;
  return pose;
}

std::vector<const UrdfLink*> UrdfLink::parts() const {
  std::vector<const UrdfLink*> parts{this};
  for (const UrdfLink* const link : below)
    if (link->is_merged) std::ranges::copy(link->parts(), std::back_inserter(parts));
  return parts;
}

std::string urdf_end(const XmlNode& joint, const char* end) {
  const XmlNode* const node = joint.child(end);
  return node != nullptr ? value_of(*node, "link") : "";
}

UrdfTree::UrdfTree(const XmlNode& robot) {
  std::map<std::string, const XmlNode*> joints;
  for (const XmlNode& child : robot.children) {
    const std::string name = value_of(child, "name");
    if (child.name == "link") {
      links_[name].name = name;
      links_[name].node = &child;
    }
    if (child.name == "joint") joints.emplace(name, &child);
    if (child.name == "gazebo") blocks_[value_of(child, "reference")].push_back(&child);
  }
  for (const auto& [name, joint] : joints) {
    UrdfLink& parent = links_.at(urdf_end(*joint, "parent"));
    UrdfLink& child = links_.at(urdf_end(*joint, "child"));
    child.joint = joint;
    child.parent = &parent;
    parent.below.push_back(&child);
  }
  for (auto& [name, link] : links_)
    if (link.parent == nullptr) root_ = &link;
  for (auto& [name, link] : links_)
    link.is_merged = link.joint != nullptr && value_of(*link.joint, "type") == "fixed" && !link.parent->is_world() &&
                     !is_set(value_of(*link.joint, "name"), "preserveFixedJoint") &&
                     !is_set(value_of(*link.joint, "name"), "disableFixedJointLumping");
}

const UrdfLink* UrdfTree::find(const std::string& link) const {
  const auto found = links_.find(link);
  return found == links_.end() ? nullptr : &found->second;
}

const std::vector<const XmlNode*>& UrdfTree::blocks(const std::string& reference) const {
  static const std::vector<const XmlNode*> none;
  const auto found = blocks_.find(reference);
  return found == blocks_.end() ? none : found->second;
}

bool UrdfTree::is_set(const std::string& joint, std::string_view flag) const {
  return std::ranges::any_of(blocks(joint), [&](const XmlNode* block) {
    return std::ranges::any_of(block->children,
                               [&](const XmlNode& child) { return child.name == flag && is_true(child); });
  });
}

}  // namespace cohort::parsing
