#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "server/geometry/shapes/footprint.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// The greatest z of a triangle above the disc around `centre`; nothing if they do not meet.
std::optional<double> highest_on_disc(const Triangle& triangle, const Eigen::Vector2d& centre, double radius);

/// From a point to what of a triangle lies between two heights, seen from above; 0 inside, infinite if there is none.
double distance_between_heights(const Triangle& triangle, double lowest, double highest, const Eigen::Vector2d& point);

/// What stands where in a world: the ground, and all that may be in the way of who looks for a place.
class Occupancy {
 public:
  /// A shape, or a triangle of a static mesh.
  struct Thing {
    geometry::Footprint footprint;  // of a triangle, the rectangle around it
    Triangle triangle = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // only if `mesh`
    std::uint32_t mesh = 0;  // which mesh the triangle belongs to; 0: none
    bool is_static = false;
  };
  struct Mesh {
    bool is_closed = false;  // what it encloses is solid
  };

  void add(const Model& model, const Pose& X_WM);

  const std::vector<Thing>& things() const { return things_; }
  const Mesh& mesh(std::uint32_t index) const { return meshes_[index]; }

  /// The highest point of planes and height maps on the disc; nothing if there are none.
  std::optional<double> terrain(const Eigen::Vector2d& centre, double radius) const;

 private:
  struct PlacedPlane {
    Eigen::Vector3d point_W;
    Eigen::Vector3d normal_W;
  };
  struct PlacedHeights {
    std::shared_ptr<const HeightGrid> grid;
    Pose X_WC;
    Pose X_CW;
    double sway = 0.0;  // how far its points may lie beside where they would be if it did not lean [m]
  };
  void add_heights(const std::shared_ptr<const HeightGrid>& grid, const Pose& X_WC);
  void add_mesh(const TriangleMesh& mesh, const Pose& X_WC);

  std::vector<Thing> things_;
  std::vector<Mesh> meshes_{{}};  // 0 is no mesh
  std::vector<PlacedPlane> planes_;
  std::vector<PlacedHeights> heights_;
};

/// The things of a occupancy in square cells over a rectangle, to ask at many points.
class OccupancyCells {
 public:
  /// `reach`: how far from a point that is asked for things may matter; `expected`: how many will be added, more or
  /// less.
  OccupancyCells(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double reach, std::size_t expected);

  void add(const Occupancy::Thing& thing);

  /// Calls `visit` for those that may be within reach of a point.
  template <class Visit>
  void for_each_around(const Eigen::Vector2d& point, Visit&& visit) const {
    for (const std::uint32_t thing : cells_[cell_of(point)]) visit(things_[thing]);
  }

 private:
  std::size_t index(double offset, std::size_t count) const;
  std::size_t cell_of(const Eigen::Vector2d& point) const {
    return index(point.y() - lower_.y(), rows_) * columns_ + index(point.x() - lower_.x(), columns_);
  }

  Eigen::Vector2d lower_;
  Eigen::Vector2d upper_;
  double reach_;
  double cell_ = 1.0;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<Occupancy::Thing> things_;
  std::vector<std::vector<std::uint32_t>> cells_;  // row by row
};

}  // namespace cohort::parsing
