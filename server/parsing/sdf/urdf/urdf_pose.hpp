// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "server/core/pose.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Returns the pose that <origin> of an element gives; the identity if there is none. Its numbers must be valid.
Pose urdf_origin(const XmlNode& node);

/// Returns the pose of SDF with this text: a position and roll, pitch and yaw. An empty text is the identity. Returns
/// nothing if the text is no pose.
std::optional<Pose> pose_of_text(const std::string& text);

/// Returns <pose> with the line of the <origin> of `source`.
XmlNode pose_at(const XmlNode& source, const Pose& pose);

/// Returns the text of a pose in SDF. It has 16 digits, like in Gazebo, so that a robot has the same bits there.
std::string text_of_pose(const Pose& pose);

}  // namespace cohort::parsing
