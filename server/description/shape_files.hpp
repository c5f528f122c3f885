#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <sdf/Element.hh>
#include <tuple>

#include "server/description/sdf_files.hpp"
#include "server/description/shape.hpp"

namespace cohort::description {

/// The shapes of a world that stand in files of their own. Each is read once, and shared by all that name it.
class ShapeFiles {
 public:
  /// `files` must outlive this.
  explicit ShapeFiles(const SdfFiles& files) : files_(files) {}

  /// The mesh that `uri` names, or its convex hull. Throws std::runtime_error that says what is wrong.
  std::shared_ptr<const TriangleMesh> mesh(const sdf::ElementPtr& uri, const Eigen::Vector3d& scale, bool convex);

  /// The height map of the image that `uri` names. Throws std::runtime_error that says what is wrong.
  std::shared_ptr<const HeightGrid> height_grid(const sdf::ElementPtr& uri, const Eigen::Vector3d& size);

 private:
  const SdfFiles& files_;
  /// By file, scale and whether convex.
  std::map<std::tuple<std::filesystem::path, double, double, double, bool>, std::shared_ptr<const TriangleMesh>>
      meshes_;
  /// By file and size.
  std::map<std::tuple<std::filesystem::path, double, double, double>, std::shared_ptr<const HeightGrid>> grids_;
};

}  // namespace cohort::description
