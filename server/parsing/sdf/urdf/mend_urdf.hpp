#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Repairs a URDF that does not follow the format but whose meaning is clear. Unknown elements are removed, missing
/// limits mean no limits, and <contact> of Bullet becomes <surface> of SDF. A link with <inertial> has a mass that is
/// not 0. Adds collisions with unsupported shapes to `problems`, and all changes that affect the motion of the robot to
/// `warnings`.
void mend_urdf(XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
               std::vector<Problem>& warnings);

}  // namespace cohort::parsing
