// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/texture_image.hpp"

/// Shapes of collisions, in the frame C of the collision. SI units.
namespace cohort::description {

struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< full edge lengths [m]
};
struct Sphere {
  double radius = 1.0;
};
/// A cylinder. Axis along z, centred on the origin.
struct Cylinder {
  double radius = 1.0;
  double length = 1.0;
};
/// A cylinder with a hemisphere on each end. Axis along z, centred on the origin.
struct Capsule {
  double radius = 1.0;
  double length = 1.0;  ///< length of the cylinder without the hemispheres
};
/// An ellipsoid, centred on the origin.
struct Ellipsoid {
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();  ///< along x, y and z
};
/// The half-space below the plane through the origin is solid. Static models only.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// The textures of a mesh, for display only.
struct MeshTextures {
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Texture coordinates of the corners of each triangle: u to the right and v upwards, 0 to 1 across an image. Empty
  /// if the file has none.
  std::vector<std::array<std::array<float, 2>, 3>> coordinates{};
  std::vector<std::uint32_t> of_triangles{};           ///< index into `images`, or `none`; empty if there are no images
  std::vector<std::shared_ptr<const Image>> images{};  ///< null: it is not shown
};

/// A simple polygon that is extruded along z, from 0 to the height.
struct Polyline {
  std::vector<Eigen::Vector2d> points;  ///< counter-clockwise or clockwise [m]
  double height = 1.0;                  ///< [m]
};

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;                ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices, counter-clockwise seen from outside
  std::filesystem::path file{};                         ///< source file, if any
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();      ///< factors applied to the coordinates of the file
  /// Red, green and blue of each triangle, for display only; none if the file has no materials.
  std::vector<std::array<std::uint8_t, 3>> colors{};
  MeshTextures textures{};            ///< if there are images, there are colours
  std::string submesh{};              ///< the part of the file that this is; empty for the whole file
  bool is_centered = false;           ///< the part was moved so that its bounding box is centred on the origin
  std::vector<Polyline> polylines{};  ///< source instead of a file
};
/// A mesh. If `convex`, the convex hull of its vertices is solid, as in all moving models. Otherwise its triangles are
/// used: a closed surface encloses a solid, and an open surface is a two-sided skin.
struct Mesh {
  std::shared_ptr<const TriangleMesh> triangles;
  bool convex = true;
};

/// Ground that is described by a few parameters instead of an image. All heights are from 0 to size.z.
struct Terrain {
  std::string kind;                                ///< sine, ramp, steps, hills or rough
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< size of the rectangle, and maximum height [m]
  double spacing = 0.05;                           ///< maximum distance between neighbouring heights [m]
  double wavelength = 1.0;                         ///< length of a wave or a step, or distance between hills [m]
  std::uint64_t seed = 0;                          ///< for hills and rough ground
};

/// Heights over a rectangle centred on the origin: columns along x, rows along y, both ascending.
struct HeightGrid {
  std::size_t columns = 0;                            ///< >= 2
  std::size_t rows = 0;                               ///< >= 2
  Eigen::Vector2d spacing = Eigen::Vector2d::Ones();  ///< between neighbouring columns and rows [m]
  std::vector<double> heights;                        ///< z, row by row [m]
  std::filesystem::path file{};                       ///< source file, if any
  Eigen::Vector3d size = Eigen::Vector3d::Ones();     ///< size given for the image [m]
  std::optional<Terrain> terrain{};                   ///< source of the heights, if not an image

  double height(std::size_t column, std::size_t row) const { return heights[row * columns + column]; }
  /// Returns the distances from the origin to the edges.
  Eigen::Vector2d half_size() const {
    return 0.5 * spacing.cwiseProduct(Eigen::Vector2d(static_cast<double>(columns - 1), static_cast<double>(rows - 1)));
  }
};
/// A height map, which is solid below its surface and empty beside its rectangle. Between four neighbouring heights the
/// surface is two triangles, whose common edge runs from (column + 1, row) to (column, row + 1). Static models only.
struct Heightmap {
  std::shared_ptr<const HeightGrid> grid;
};

using Shape = std::variant<Box, Sphere, Cylinder, Plane, Capsule, Ellipsoid, Mesh, Heightmap>;

}  // namespace cohort::description
