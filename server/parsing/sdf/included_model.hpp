// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/core/pose.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/frames.hpp"

/// Replacement of an <include> in a tree.
namespace cohort::parsing {

/// Replaces the first child of the same name, or adds the child at the end.
void set_child(XmlNode& node, const XmlNode& child);

/// Returns whether an attribute of this name has a frame as its value.
bool refers_to_frame(const std::string& attribute);

/// Returns a pose in the world frame. Returns nothing if it names another frame or is invalid, which is
/// reported elsewhere.
std::optional<Pose> pose_in_world(const XmlNode* pose);

/// Returns the model of a file with the changes of an <include>.
XmlNode as_included(const XmlNode& model, const XmlNode& include);

/// Returns the frames of a model, without anything that has mass or shape.
XmlNode frames_of(const XmlNode& model);

/// Returns the elements that <include merge="true"> adds to a model: all named parts of the included model `model`,
/// whose own frame becomes a <frame>. Names are as in libsdformat, since other files may refer to them. `frames` are
/// those of `model`.
std::vector<XmlNode> merged(const XmlNode& model, const Frames& frames, const XmlNode& include);

}  // namespace cohort::parsing
