// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

/// The replacement of a collision whose mesh file does not exist.
enum class MissingMesh : std::uint8_t {
  refused,  ///< nothing: it is an error
  box,      ///< a cube of `missing_mesh_size`
  skip,     ///< nothing: the collision is left out
};

/// Edges of the cube that replaces a mesh of unknown size [m].
inline constexpr double missing_mesh_size = 0.1;

/// The environment variable for files from the disk: `box`, `skip`, or another value for an error.
inline constexpr const char* missing_meshes_variable = "COHORT_MISSING_MESHES";

/// Returns the replacement of the missing mesh that `uri` names in a file in `folder`. Keeps the answer among the kept
/// files, so that reading them again gives the same answer without the variable.
MissingMesh replacement_of_mesh(InputFiles& input, const std::filesystem::path& folder, const std::string& uri);

}  // namespace cohort::parsing
