#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <sdf/Element.hh>
#include <utility>

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
  struct Key {
    std::filesystem::path file;
    std::array<double, 3> size;
    bool convex;
    auto operator<=>(const Key&) const = default;
  };

  const SdfFiles& files_;
  std::map<Key, std::shared_ptr<const TriangleMesh>> meshes_;
  std::map<Key, std::shared_ptr<const HeightGrid>> grids_;
};

}  // namespace cohort::description
