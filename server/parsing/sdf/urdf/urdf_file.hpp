// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Converts a URDF <robot> to an <sdf> element, in which each element has the line of its URDF element. Adds problems,
/// with their lines, to `problems`, and then returns nothing; adds omitted features to `warnings`.
std::optional<XmlNode> sdf_of_urdf(XmlNode robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                                   std::vector<Problem>& warnings);

/// Repairs a URDF that does not follow the format but whose meaning is clear. Unknown elements are removed, missing
/// limits mean no limits, and <contact> of Bullet becomes <surface> of SDF. A link with <inertial> has a mass that is
/// not 0. Adds collisions with unsupported shapes to `problems`, and all changes that affect the motion of the robot to
/// `warnings`.
void mend_urdf(XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
               std::vector<Problem>& warnings);

/// Checks a URDF <robot> against the format for errors that prevent its conversion: names, references,
/// numbers, and that the links form one tree.
void check_urdf(const XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                std::vector<Problem>& warnings);

}  // namespace cohort::parsing
