#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Replaces '::' by '.' in the names of a file, and in references from the same model. Up to SDF 1.7 such names belong
/// to a nested model whose parts are in the outer one. As parts of the outer model with the new names, they can refer
/// to anything. Reports the first position if `warnings` is given.
void join_scoped_names(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>* warnings);

}  // namespace cohort::parsing
