// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/shape_files.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "server/geometry/shapes/convex_hull.hpp"
#include "server/parsing/files/height_image.hpp"

namespace cohort::parsing {
namespace {

// Thickens points to a volume: a plate or a rod gets a minimum thickness.
std::vector<Eigen::Vector3d> thickened(const std::vector<Eigen::Vector3d>& points) {
  constexpr double thickness = 1e-3;  // [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centre += point / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) spread += (point - centre) * (point - centre).transpose();
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  std::vector<Eigen::Vector3d> thick = points;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = axes.col(i);
    const auto along = [&](const Eigen::Vector3d& point) { return axis.dot(point); };
    const auto [least, most] = std::ranges::minmax(points, {}, along);
    if (along(most) - along(least) >= thickness) continue;
    const std::size_t count = thick.size();
    for (std::size_t point = 0; point < count; ++point) {
      thick.push_back(thick[point] + 0.5 * thickness * axis);
      thick[point] -= 0.5 * thickness * axis;
    }
  }
  return thick;
}

TriangleMesh hull_of(const TriangleMesh& mesh, const std::filesystem::path& file, bool may_be_flat) {
  try {
    return geometry::convex_hull(mesh.vertices);
  } catch (const std::invalid_argument&) {
    if (may_be_flat && !mesh.vertices.empty()) return geometry::convex_hull(thickened(mesh.vertices));
    throw std::runtime_error("the mesh of '" + file.string() +
                             "' is flat; the convex hull of a mesh in a moving model must have a volume");
  }
}

}  // namespace

std::shared_ptr<const TriangleMesh> ShapeFiles::mesh(const Element* uri, const Eigen::Vector3d& scale, bool convex,
                                                     const MeshPart& which) {
  const std::filesystem::path file = files_.find_file(uri);
  ReadMesh& mesh = meshes_[key_of(file, which, scale, convex)];
  if (mesh.triangles) return mesh.triangles;
  const auto whole = convex ? meshes_.find(key_of(file, which, scale, false)) : meshes_.end();
  const bool is_read = whole != meshes_.end() && whole->second.triangles != nullptr;
  ImportedMesh read;
  if (!is_read) read = reader_.read(files_.input(), file, scale, which);
  TriangleMesh triangles = convex
                               ? hull_of(is_read ? *whole->second.triangles : read, file, uri->node().file->is_foreign)
                               : TriangleMesh(std::move(static_cast<TriangleMesh&>(read)));
  triangles.file = file;
  triangles.scale = scale;
  triangles.submesh = which.submesh;
  triangles.is_centered = which.is_centered;
  if (!convex) mesh.warnings = add_images(read.images, triangles);
  mesh.triangles = std::make_shared<const TriangleMesh>(std::move(triangles));
  return mesh.triangles;
}

bool ShapeFiles::is_missing(const Element* uri) const {
  try {
    return !files_.input().is_file(files_.find_file(uri));
  } catch (const std::runtime_error&) {  // no place is known for it
    return true;
  }
}

MissingMesh ShapeFiles::replacement_of(const Element* uri) {
  if (!is_missing(uri)) return MissingMesh::refused;
  std::pair mesh(uri->node().file->path.parent_path(), uri->text());
  const MissingMesh replacement = replacement_of_mesh(files_.input(), mesh.first, mesh.second);
  if (replacement != MissingMesh::refused) replaced_.insert(std::move(mesh));
  return replacement;
}

const std::vector<std::string>& ShapeFiles::warnings_of(const TriangleMesh& mesh) const {
  return meshes_.at(key_of(mesh.file, {mesh.submesh, mesh.is_centered}, mesh.scale, false)).warnings;
}

// Returns warnings for images that cannot be shown.
std::vector<std::string> ShapeFiles::add_images(std::vector<MeshImage>& images, TriangleMesh& mesh) {
  std::vector<std::string> warnings;
  mesh.textures.images.reserve(images.size());
  for (MeshImage& image : images) {
    std::shared_ptr<const Image>& added = mesh.textures.images.emplace_back();
    try {
      if (image.name.empty() && image.bytes.empty())
        throw std::runtime_error("expected an embedded PNG or JPEG image of at most 8 MiB");
      added = image.name.empty() ? images_.embedded_image(std::move(image.bytes))
                                 : images_.image_of_mesh(std::move(image.name), mesh.file);
    } catch (const std::runtime_error& error) {
      warnings.push_back(texture_not_shown(error));
    }
  }
  return warnings;
}

std::shared_ptr<const HeightGrid> ShapeFiles::height_grid(const Element* uri, const Eigen::Vector3d& size) {
  const std::filesystem::path file = files_.find_file(uri);
  std::shared_ptr<const HeightGrid>& grid = grids_[{file, size.x(), size.y(), size.z()}];
  if (grid) return grid;
  HeightGrid read = read_height_image(files_.input(), file, size);
  read.file = file;
  read.size = size;
  grid = std::make_shared<const HeightGrid>(std::move(read));
  return grid;
}

std::shared_ptr<const Samples> ShapeFiles::samples(const Element* uri) {
  const std::filesystem::path file = files_.find_file(uri);
  std::shared_ptr<const Samples>& samples = samples_[file];
  if (!samples) samples = std::make_shared<const Samples>(read_samples(files_.input(), file));
  return samples;
}

}  // namespace cohort::parsing
