#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <sdf/Element.hh>
#include <tuple>

#include "server/description/shape.hpp"
#include "server/parsing/files/sample_file.hpp"
#include "server/parsing/sdf/sdf_files.hpp"

namespace cohort::parsing {

/// What a world names that stands in files of its own: shapes and samples. Each is read once, and shared by all that
/// name it.
class ShapeFiles {
 public:
  /// `files` must outlive this.
  explicit ShapeFiles(const SdfFiles& files) : files_(files) {}

  /// The mesh that `uri` names, or its convex hull; a flat one in a file of others is 1 mm thick then. Throws
  /// std::runtime_error that says what is wrong.
  std::shared_ptr<const TriangleMesh> mesh(const sdf::ElementPtr& uri, const Eigen::Vector3d& scale, bool convex);

  /// The height map of the image that `uri` names. Throws std::runtime_error that says what is wrong.
  std::shared_ptr<const HeightGrid> height_grid(const sdf::ElementPtr& uri, const Eigen::Vector3d& size);

  /// The samples that `uri` names. Throws InputError with what is wrong in the file, or std::runtime_error if there is
  /// none.
  std::shared_ptr<const Samples> samples(const sdf::ElementPtr& uri);

 private:
  const SdfFiles& files_;
  /// By file, scale and whether convex.
  std::map<std::tuple<std::filesystem::path, double, double, double, bool>, std::shared_ptr<const TriangleMesh>>
      meshes_;
  /// By file and size.
  std::map<std::tuple<std::filesystem::path, double, double, double>, std::shared_ptr<const HeightGrid>> grids_;
  std::map<std::filesystem::path, std::shared_ptr<const Samples>> samples_;
};

}  // namespace cohort::parsing
