// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/tree/counted_warnings.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

/// Steps of mend_urdf() on single elements.
namespace cohort::parsing {

/// Returns an element as a step of a path, such as `link[NAME]`.
inline std::string urdf_step(const XmlNode& node) { return path_step(node.name, value_of(node, "name")); }

/// Notes about changes in a URDF, for its author. A note about many elements is reported once.
class UrdfNotes {
 public:
  UrdfNotes(const std::filesystem::path& file, std::vector<Problem>& warnings) : file_(file), warnings_(warnings) {}

  void warn(const XmlNode& node, const std::string& path, const std::string& message) {
    warnings_.push_back({file_, node.line, path, message});
  }
  void pass_over(const XmlNode& node, const std::string& path, const std::string& message) {
    unknown_.add({file_, node.line, path, ""}, message);
  }
  void tell() const { unknown_.tell(warnings_); }

 private:
  const std::filesystem::path& file_;
  std::vector<Problem>& warnings_;
  CountedWarnings unknown_;
};

/// Renames joints that have the name of a link, which SDF does not allow.
void name_joints_apart(XmlNode& robot, UrdfNotes& notes);

/// Gives a joint a known type and limits; missing limits mean no limits.
void mend_joint(XmlNode& joint, UrdfNotes& notes);

/// Removes a root without mass whose only joint is a floating one, so that its child is the root.
void omit_empty_root(XmlNode& robot);

/// Removes <mimic> that names a missing joint.
void omit_lost_mimics(XmlNode& robot, UrdfNotes& notes);

/// Returns <surface> of SDF for <contact> of Bullet: friction, restitution and stiffness of the surface of a link.
/// Returns nothing if the element has no known content.
std::optional<XmlNode> surface_of(const XmlNode& contact, const std::string& path, UrdfNotes& notes);

}  // namespace cohort::parsing
