// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Replaces elements that SDF 1.10 or later introduced by equivalents that the reader supports, in files of any
/// version. Inertia from density and joints that follow others become `cohort:` elements, and a cone becomes a
/// cylinder. Wrong values are reported as problems, and what is changed or ignored as warnings.
void take_newer(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& problems,
                std::vector<Problem>& warnings);

}  // namespace cohort::parsing
