#pragma once

#include <ignition/math/Pose3.hh>
#include <optional>
#include <sdf/Model.hh>
#include <string>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"

/// Replacement of an <include> in a tree.
namespace cohort::parsing {

/// Replaces the first child of the same name, or adds the child at the end.
void set_child(XmlNode& node, const XmlNode& child);

/// Returns whether an attribute of this name has a frame as its value.
bool refers_to_frame(const std::string& attribute);

/// Returns a pose in the world frame. Returns nothing if it names another frame or is invalid, which libsdformat
/// reports.
std::optional<ignition::math::Pose3d> pose_in_world(const XmlNode* pose);

/// Returns the model of a file with the changes of an <include>.
XmlNode as_included(const XmlNode& model, const XmlNode& include);

/// Returns the frames of a model, without anything that has mass or shape.
XmlNode frames_of(const XmlNode& model);

/// Returns the elements that <include merge="true"> adds to a model: all named parts of the other, whose frame becomes
/// a <frame>. The result and the names are those of libsdformat. `sdf_model` was made from `model`.
std::vector<XmlNode> merged(const XmlNode& model, const sdf::Model& sdf_model, const XmlNode& include);

}  // namespace cohort::parsing
