// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Repairs an SDF file from another source that other programs accept although it does not follow the format: duplicate
/// or reserved names, links without mass, axes without direction, unknown sensors. Adds each change to `warnings`.
void mend_sdf(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
