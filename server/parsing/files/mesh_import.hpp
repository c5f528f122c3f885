#pragma once

#include <filesystem>
#include <string>

#include "server/description/shape.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// The files that importing a mesh takes: its own, and those that it names, such as the .mtl of an .obj.
class MeshSources {
 public:
  virtual ~MeshSources() = default;
  virtual bool is_file(const std::string& file) = 0;
  /// Returns the content, which stays where it is as long as this lives; null if `file` may not or cannot be read.
  virtual const std::string* read(const std::string& file) = 0;
};

/// As read_mesh, in this process: a file that was made for it can crash Assimp, or make it fill the memory.
TriangleMesh import_mesh(MeshSources& sources, const std::filesystem::path& file, const Eigen::Vector3d& scale);

}  // namespace cohort::parsing
