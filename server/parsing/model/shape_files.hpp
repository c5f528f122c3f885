// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "server/description/shape.hpp"
#include "server/parsing/files/mesh_file.hpp"
#include "server/parsing/files/mesh_import.hpp"
#include "server/parsing/files/missing_meshes.hpp"
#include "server/parsing/files/sample_file.hpp"
#include "server/parsing/model/image_files.hpp"
#include "server/parsing/sdf/sdf_files.hpp"

namespace cohort::parsing {

/// Returns the warning for a texture that cannot be shown.
inline std::string texture_not_shown(const std::runtime_error& error) {
  return std::string("the texture is not shown: ") + error.what();
}

/// The shapes and samples that a world has in separate files. Each is read once, and shared by all that name it.
class ShapeFiles {
 public:
  /// `files` must outlive this.
  explicit ShapeFiles(const SdfFiles& files) : files_(files), images_(files) {}

  ImageFiles& images() { return images_; }

  /// Returns the mesh that `uri` names, or its convex hull; in a file from another source, a flat hull gets a thickness
  /// of 1 mm. Throws std::runtime_error with the problem.
  std::shared_ptr<const TriangleMesh> mesh(const Element* uri, const Eigen::Vector3d& scale, bool convex,
                                           const MeshPart& which = {});

  bool is_missing(const Element* uri) const;  ///< returns whether a mesh has no file
  /// Returns the replacement of the mesh that `uri` names, which could not be read; MissingMesh::refused if its file
  /// exists.
  MissingMesh replacement_of(const Element* uri);
  /// Returns the number of meshes with a replacement.
  std::size_t replaced_meshes() const { return replaced_.size(); }

  /// Returns warnings for the textures of a mesh that `mesh` has returned and that is not a convex hull.
  const std::vector<std::string>& warnings_of(const TriangleMesh& mesh) const;

  /// Returns the height map of the image that `uri` names. Throws std::runtime_error with the problem.
  std::shared_ptr<const HeightGrid> height_grid(const Element* uri, const Eigen::Vector3d& size);

  /// Returns the samples that `uri` names. Throws InputError with the problems of the file, or std::runtime_error if
  /// there is no such file.
  std::shared_ptr<const Samples> samples(const Element* uri);

 private:
  struct ReadMesh {
    std::shared_ptr<const TriangleMesh> triangles;
    std::vector<std::string> warnings;
  };
  std::vector<std::string> add_images(std::vector<MeshImage>& images, TriangleMesh& mesh);

  const SdfFiles& files_;
  ImageFiles images_;
  MeshReader reader_;
  /// A file, the part of it, its scale, and whether the mesh is convex.
  using MeshKey = std::tuple<std::filesystem::path, std::string, bool, double, double, double, bool>;
  static MeshKey key_of(const std::filesystem::path& file, const MeshPart& which, const Eigen::Vector3d& scale,
                        bool convex) {
    return {file, which.submesh, which.is_centered, scale.x(), scale.y(), scale.z(), convex};
  }

  std::map<MeshKey, ReadMesh> meshes_;
  /// Height maps by file and size.
  std::map<std::tuple<std::filesystem::path, double, double, double>, std::shared_ptr<const HeightGrid>> grids_;
  std::map<std::filesystem::path, std::shared_ptr<const Samples>> samples_;
  std::set<std::pair<std::filesystem::path, std::string>> replaced_;  ///< meshes by folder and URI
};

}  // namespace cohort::parsing
