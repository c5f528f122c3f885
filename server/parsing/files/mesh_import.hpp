#pragma once

#include <filesystem>
#include <string>

#include "server/description/shape.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// The files that a mesh import needs: the mesh, and files that it names, such as the .mtl of an .obj.
class MeshSources {
 public:
  virtual ~MeshSources() = default;
  virtual bool is_file(const std::string& file) = 0;
  /// Returns the content, whose address does not change during the lifetime of this; null if `file` cannot or must not
  /// be read.
  virtual const std::string* read(const std::string& file) = 0;
};

/// Does the same as read_mesh in this process: a malicious file can crash Assimp, or make it exhaust the memory.
TriangleMesh import_mesh(MeshSources& sources, const std::filesystem::path& file, const Eigen::Vector3d& scale);

}  // namespace cohort::parsing
