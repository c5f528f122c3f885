#pragma once

#include <filesystem>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Writes '.' for each '::' in the names of a file, and wherever the same model refers to them. Up to SDF 1.7 such
/// names are those of a nested model whose parts stand in the outer one. libsdformat would nest them again, and stops
/// the process where a joint, a frame or a pose refers to what is outside of the nested model. As parts of the outer
/// model they are called the same here, and refer to what they like. The first place is told if `warnings` is given.
void join_scoped_names(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>* warnings);

}  // namespace cohort::parsing
