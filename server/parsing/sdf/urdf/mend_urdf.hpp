#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_rest.hpp"

namespace cohort::parsing {

/// Repairs a URDF that does not follow the format but whose meaning is clear. Unknown elements are removed, and
/// <contact> and <capsule> of Bullet are set aside. Missing limits mean no limits, and a root link without mass is
/// fixed to the world. Adds collisions with unsupported shapes to `problems`, and all changes that affect the motion of
/// the robot to `warnings`.
UrdfRest mend_urdf(XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                   std::vector<Problem>& warnings);

}  // namespace cohort::parsing
