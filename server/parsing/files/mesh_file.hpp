#pragma once

#include <filesystem>
#include <stdexcept>

#include "server/description/shape.hpp"
#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

/// A mesh that crashed its importer, or for which that needed more memory or time than it may.
struct ImporterFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads all triangles of an STL, OBJ or COLLADA file. Coordinates are as in the file, in metres, multiplied by
/// `scale`; a unit that a COLLADA file gives is heeded, its up-axis is not. Vertices at the same place are one. Colours
/// are those of materials (of an OBJ in its .mtl), where there are any. The importer is a process of its own
/// (LimitedChild). Throws std::runtime_error that says what is wrong with the file, or ImporterFailed.
TriangleMesh read_mesh(InputFiles& input, const std::filesystem::path& file, const Eigen::Vector3d& scale);

}  // namespace cohort::parsing
