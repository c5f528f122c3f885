#include "server/parsing/model/shape_files.hpp"

#include <stdexcept>
#include <utility>

#include "server/geometry/shapes/convex_hull.hpp"
#include "server/parsing/files/height_image.hpp"
#include "server/parsing/files/mesh_file.hpp"

namespace cohort::parsing {
namespace {

TriangleMesh hull_of(const TriangleMesh& mesh, const std::filesystem::path& file) {
  try {
    return geometry::convex_hull(mesh.vertices);
  } catch (const std::invalid_argument&) {
    throw std::runtime_error("the mesh of '" + file.string() +
                             "' is flat; in a model that moves, its convex hull is solid, and needs a volume");
  }
}

}  // namespace

std::shared_ptr<const TriangleMesh> ShapeFiles::mesh(const sdf::ElementPtr& uri, const Eigen::Vector3d& scale,
                                                     bool convex) {
  const std::filesystem::path file = files_.find_file(uri);
  std::shared_ptr<const TriangleMesh>& mesh = meshes_[{file, scale.x(), scale.y(), scale.z(), convex}];
  if (mesh) return mesh;
  TriangleMesh read = read_mesh(files_.input(), file, scale);
  if (convex) read = hull_of(read, file);
  read.file = file;
  read.scale = scale;
  mesh = std::make_shared<const TriangleMesh>(std::move(read));
  return mesh;
}

std::shared_ptr<const HeightGrid> ShapeFiles::height_grid(const sdf::ElementPtr& uri, const Eigen::Vector3d& size) {
  const std::filesystem::path file = files_.find_file(uri);
  std::shared_ptr<const HeightGrid>& grid = grids_[{file, size.x(), size.y(), size.z()}];
  if (grid) return grid;
  HeightGrid read = read_height_image(files_.input(), file, size);
  read.file = file;
  read.size = size;
  grid = std::make_shared<const HeightGrid>(std::move(read));
  return grid;
}

std::shared_ptr<const Samples> ShapeFiles::samples(const sdf::ElementPtr& uri) {
  const std::filesystem::path file = files_.find_file(uri);
  std::shared_ptr<const Samples>& samples = samples_[file];
  if (!samples) samples = std::make_shared<const Samples>(read_samples(files_.input(), file));
  return samples;
}

}  // namespace cohort::parsing
