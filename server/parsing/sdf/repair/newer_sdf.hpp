#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Replaces elements that SDF has had since 1.10 by what is read, in files of every version. Inertia by density, joints
/// that follow others and joints in a world become `cohort:` elements. Wrong values are reported as problems, and what
/// is changed or ignored as warnings.
void take_newer(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& problems,
                std::vector<Problem>& warnings);

}  // namespace cohort::parsing
