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

/// What a collision may be made of, in its own frame C. SI units.
namespace cohort::description {

struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< full edge lengths [m]
};
struct Sphere {
  double radius = 1.0;
};
/// Axis along z, centred on the origin.
struct Cylinder {
  double radius = 1.0;
  double length = 1.0;
};
/// A cylinder with a half sphere on either end. Axis along z, centred on the origin.
struct Capsule {
  double radius = 1.0;
  double length = 1.0;  ///< of the cylinder, without the half spheres
};
/// Centred on the origin.
struct Ellipsoid {
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();  ///< along x, y and z
};
/// The half-space below the plane through the origin is solid. Static models only.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;                ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices, counter-clockwise seen from outside
  std::filesystem::path file{};                         ///< where they came from, if anywhere
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();      ///< that the coordinates of the file were multiplied by
  /// Red, green and blue of each triangle, for the eye alone; none if the file has no materials.
  std::vector<std::array<std::uint8_t, 3>> colors{};
};
/// If `convex`, the convex hull of the vertices is solid: so in all models that move. Otherwise the triangles
/// themselves: where they close a surface, what it encloses is solid, and where they do not, they are a skin with two
/// sides.
struct Mesh {
  std::shared_ptr<const TriangleMesh> triangles;
  bool convex = true;
};

/// Ground that is described by a few numbers instead of an image. All heights are from 0 to size.z.
struct Terrain {
  std::string kind;                                ///< sine, ramp, steps, hills or rough
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< of the rectangle, and its greatest height [m]
  double spacing = 0.05;                           ///< between neighbouring heights, at the most [m]
  double wavelength = 1.0;                         ///< of waves; length of a step; distance between hills [m]
  std::uint64_t seed = 0;                          ///< of hills and rough ground
};

/// Heights over a rectangle that is centred on the origin: columns along x, rows along y, both ascending.
struct HeightGrid {
  std::size_t columns = 0;                            ///< >= 2
  std::size_t rows = 0;                               ///< >= 2
  Eigen::Vector2d spacing = Eigen::Vector2d::Ones();  ///< between neighbouring columns and rows [m]
  std::vector<double> heights;                        ///< z, row by row [m]
  std::filesystem::path file{};                       ///< where they came from, if anywhere
  Eigen::Vector3d size = Eigen::Vector3d::Ones();     ///< that the image was given [m]
  std::optional<Terrain> terrain{};                   ///< what they were made from, in place of an image

  double height(std::size_t column, std::size_t row) const { return heights[row * columns + column]; }
  /// From the origin to the edges.
  Eigen::Vector2d half_size() const {
    return 0.5 * spacing.cwiseProduct(Eigen::Vector2d(static_cast<double>(columns - 1), static_cast<double>(rows - 1)));
  }
};
/// What is below the surface is solid; beside the rectangle there is nothing. Between four neighbouring heights the
/// surface is two triangles, whose common edge runs from (column + 1, row) to (column, row + 1). Static models only.
struct Heightmap {
  std::shared_ptr<const HeightGrid> grid;
};

using Shape = std::variant<Box, Sphere, Cylinder, Plane, Capsule, Ellipsoid, Mesh, Heightmap>;

}  // namespace cohort::description
