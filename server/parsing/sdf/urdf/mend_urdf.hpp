#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_rest.hpp"

namespace cohort::parsing {

/// Makes of a URDF as it is found in the field one that the format allows, where it is plain what is meant: what is
/// unknown is left out, Bullet's <contact> and <capsule> are put aside, limits that are missing are none, and a root
/// without mass is held by the world. `problems` has collisions of a shape that is not supported, `warnings` all that
/// changes how the robot moves.
UrdfRest mend_urdf(XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                   std::vector<Problem>& warnings);

}  // namespace cohort::parsing
