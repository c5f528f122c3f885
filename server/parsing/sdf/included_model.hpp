#pragma once

#include <ignition/math/Pose3.hh>
#include <optional>
#include <sdf/Model.hh>
#include <string>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"

/// What stands in a tree for an <include>.
namespace cohort::parsing {

/// Puts a child in the place of the first of its name, or at the end.
void set_child(XmlNode& node, const XmlNode& child);

/// Returns whether an attribute of this name has a frame as its value.
bool refers_to_frame(const std::string& attribute);

/// Returns the pose of what is placed in the world's own frame. Returns nothing if another frame is named, or if
/// anything is wrong with it, which libsdformat is to say.
std::optional<ignition::math::Pose3d> pose_in_world(const XmlNode* pose);

/// Returns the model of a file as an <include> has it.
XmlNode as_included(const XmlNode& model, const XmlNode& include);

/// Returns the frames of a model, without anything that has mass or shape.
XmlNode frames_of(const XmlNode& model);

/// Returns what <include merge="true"> puts into a model: all named parts of the other, whose own frame becomes a
/// <frame>. It is as libsdformat does it, in the same names. `sdf_model` is made of `model`.
std::vector<XmlNode> merged(const XmlNode& model, const sdf::Model& sdf_model, const XmlNode& include);

}  // namespace cohort::parsing
