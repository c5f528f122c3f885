// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "server/description/shape.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/limited_child.hpp"
#include "server/parsing/files/mesh_import.hpp"

namespace cohort::parsing {

/// The importer crashed on a mesh, or exceeded its limits of memory or time.
struct ImporterFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads meshes. The importer is a separate process (LimitedChild).
class MeshReader {
 public:
  /// Reads all triangles of an STL, OBJ, COLLADA or glTF file. Coordinates are those of the file, in metres, multiplied
  /// by `scale`; the unit of a COLLADA file is applied, its up-axis is not. Vertices at the same position are merged.
  /// Colours are those of materials (of an OBJ in its .mtl), if any. If `which` names a submesh that the file does not
  /// have, the message lists those that it has. Throws std::runtime_error with the problem of the file, or
  /// ImporterFailed.
  ImportedMesh read(InputFiles& input, const std::filesystem::path& file, const Eigen::Vector3d& scale,
                    const MeshPart& which = {});

 private:
  std::unique_ptr<LimitedChild> importer_;  // null before the first file, and after one that could not be read
};

}  // namespace cohort::parsing
