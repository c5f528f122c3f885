// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Replaces '::' by '.' in the names of a file, and in references from the same model. Up to SDF 1.7, such names belong
/// to parts of a nested model that are written in the outer model. With their new names, these are ordinary parts of
/// the outer model and may refer to any of its parts. Reports the first position if `warnings` is given.
void join_scoped_names(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>* warnings);

}  // namespace cohort::parsing
