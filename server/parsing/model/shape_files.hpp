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

/// The shapes and samples that a world has in separate files. Each is read once, and shared by all that name it.
class ShapeFiles {
 public:
  /// `files` must outlive this.
  explicit ShapeFiles(const SdfFiles& files) : files_(files) {}

  /// Returns the mesh that `uri` names, or its convex hull; in a file from another source, a flat hull gets a thickness
  /// of 1 mm. Throws std::runtime_error with the problem.
  std::shared_ptr<const TriangleMesh> mesh(const sdf::ElementPtr& uri, const Eigen::Vector3d& scale, bool convex);

  /// Returns the height map of the image that `uri` names. Throws std::runtime_error with the problem.
  std::shared_ptr<const HeightGrid> height_grid(const sdf::ElementPtr& uri, const Eigen::Vector3d& size);

  /// Returns the samples that `uri` names. Throws InputError with the problems of the file, or std::runtime_error if
  /// there is no such file.
  std::shared_ptr<const Samples> samples(const sdf::ElementPtr& uri);

 private:
  const SdfFiles& files_;
  /// Meshes by file, scale and whether convex.
  std::map<std::tuple<std::filesystem::path, double, double, double, bool>, std::shared_ptr<const TriangleMesh>>
      meshes_;
  /// Height maps by file and size.
  std::map<std::tuple<std::filesystem::path, double, double, double>, std::shared_ptr<const HeightGrid>> grids_;
  std::map<std::filesystem::path, std::shared_ptr<const Samples>> samples_;
};

}  // namespace cohort::parsing
