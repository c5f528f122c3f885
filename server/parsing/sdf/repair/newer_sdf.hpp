#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Makes of a file of SDF 1.10 to 1.12 one of the newest version that libsdformat reads: inertia by density, joints
/// that follow others and joints in a world become elements of ours. What has no counterpart goes to `warnings`.
void make_older(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
