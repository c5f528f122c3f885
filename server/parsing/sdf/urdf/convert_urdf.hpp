#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Returns the <model> of SDF for a mended URDF without errors, as Gazebo makes it: links that fixed joints connect
/// become one link. Every element has the line of its source in the URDF; parts of links have `written`.
XmlNode convert_urdf(const XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
