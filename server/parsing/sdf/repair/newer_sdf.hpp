#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Converts elements that SDF has had since 1.10 to what libsdformat reads, in files of every version. Inertia
/// by density, joints that follow others and joints in a world become `cohort:` elements. Other new features go to
/// `warnings`.
void make_older(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
