#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Makes of a file of SDF that was not written for Cohort one that libsdformat reads, where it would stop at what other
/// readers take: names that are given twice or are reserved, links without mass, axes without direction, sensors that
/// it does not know. Each is told in `warnings`.
void mend_sdf(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
