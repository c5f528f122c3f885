// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

/// An image that a mesh has as a texture.
struct MeshImage {
  std::string name;   ///< its file, as the mesh names it; empty if it is embedded
  std::string bytes;  ///< content, if it is embedded and not larger than the limit for images
};

/// A mesh whose textures have no images yet: they are those of `images`, in the same order.
struct ImportedMesh : TriangleMesh {
  std::vector<MeshImage> images{};
};

/// The part of a mesh file that is read.
struct MeshPart {
  std::string submesh{};     ///< name of a node or a mesh in the file; empty for everything
  bool is_centered = false;  ///< the centre of its bounding box is moved to the origin
};

/// Does the same as MeshReader in this process: a malicious file can crash Assimp, or make it exhaust the memory.
ImportedMesh import_mesh(MeshSources& sources, const std::filesystem::path& file, const Eigen::Vector3d& scale,
                         const MeshPart& which = {});

}  // namespace cohort::parsing
