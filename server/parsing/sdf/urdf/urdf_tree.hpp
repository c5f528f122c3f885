// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/core/pose.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// A link of a URDF.
struct UrdfLink {
  std::string name;
  const XmlNode* node = nullptr;
  const XmlNode* joint = nullptr;      ///< above it; nullptr for the root
  const UrdfLink* parent = nullptr;    ///< nullptr for the root
  bool is_merged = false;              ///< with its parent, by a fixed joint
  std::vector<const UrdfLink*> below;  ///< in the order of the names of their joints

  bool is_world() const { return parent == nullptr && name == "world"; }
  /// Returns the link of which this one becomes a part: itself, if it is not merged.
  const UrdfLink& carrier() const;
  /// Returns a pose in the frame of this link as a pose in the frame of its carrier.
  Pose in_carrier(Pose pose) const;
  /// Returns this link and those that are merged with it, from the root outwards, in the order of Gazebo.
  std::vector<const UrdfLink*> parts() const;
};

/// Returns the link that <parent> or <child> of a joint names; empty if there is none.
std::string urdf_end(const XmlNode& joint, const char* end);

/// The links and <gazebo> blocks of a URDF without errors, which must outlive it.
class UrdfTree {
 public:
  explicit UrdfTree(const XmlNode& robot);
  UrdfTree(const UrdfTree&) = delete;
  UrdfTree& operator=(const UrdfTree&) = delete;

  const UrdfLink& root() const { return *root_; }
  /// Returns nullptr for an unknown name.
  const UrdfLink* find(const std::string& link) const;
  /// Returns the <gazebo> blocks with this reference; those of the robot have an empty one.
  const std::vector<const XmlNode*>& blocks(const std::string& reference) const;
  /// Returns whether a <gazebo> block of the joint sets a flag, such as `preserveFixedJoint`, to true.
  bool is_set(const std::string& joint, std::string_view flag) const;

 private:
  std::map<std::string, UrdfLink> links_;
  std::map<std::string, std::vector<const XmlNode*>> blocks_;
  const UrdfLink* root_ = nullptr;
};

}  // namespace cohort::parsing
