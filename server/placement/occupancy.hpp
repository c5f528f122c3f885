// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/description/model.hpp"
#include "server/geometry/shapes/footprint.hpp"
#include "server/placement/placement.hpp"

namespace cohort::placement {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Returns the greatest z of a triangle above the disc around `centre`; nothing if they do not intersect.
std::optional<double> highest_on_disc(const Triangle& triangle, const Eigen::Vector2d& centre, double radius);

/// Returns the horizontal distance from a point to the part of a triangle between two heights: 0 inside, infinite if
/// there is no such part.
double distance_between_heights(const Triangle& triangle, double lowest, double highest, const Eigen::Vector2d& point);

/// The occupied space of a world: the ground, and all obstacles to placement.
class Occupancy {
 public:
  /// A shape, or a triangle of a static mesh.
  struct Thing {
    geometry::Footprint footprint;  // bounding rectangle for a triangle
    Triangle triangle = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // only if `mesh`
    std::uint32_t mesh = 0;  // which mesh the triangle belongs to; 0: none
    bool is_closed = false;  // the mesh encloses a solid volume
    bool is_static = false;
  };

  /// Meshes are numbered from `first_mesh` on.
  explicit Occupancy(std::uint32_t first_mesh = 1) : next_mesh_(first_mesh) {}

  void add(const Model& model, const Pose& X_WM);

  const std::vector<Thing>& things() const { return things_; }
  std::uint32_t next_mesh() const { return next_mesh_; }

  /// Returns the highest point of planes and height maps on the disc; nothing if there are none.
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
    double sway = 0.0;  // bound of the horizontal displacement of its points by its tilt [m]
  };
  void add_heights(const std::shared_ptr<const HeightGrid>& grid, const Pose& X_WC);
  void add_mesh(const TriangleMesh& mesh, const Pose& X_WC);

  std::vector<Thing> things_;
  std::uint32_t next_mesh_;
  std::vector<PlacedPlane> planes_;
  std::vector<PlacedHeights> heights_;
};

/// Square cells over a rectangle.
class Cells {
 public:
  /// `reach`: maximum distance at which objects matter to a queried point; `expected`: approximate number of objects.
  Cells(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double reach, std::size_t expected);

  std::size_t count() const { return columns_ * rows_; }
  std::size_t cell_of(const Eigen::Vector2d& point) const {
    return index(point.y() - lower_.y(), rows_) * columns_ + index(point.x() - lower_.x(), columns_);
  }
  /// Calls `visit` with each cell that contains points within reach of a footprint.
  template <class Visit>
  void for_each_near(const geometry::Footprint& footprint, Visit&& visit) const {
    const Eigen::Vector2d reach = footprint.half_extent() + Eigen::Vector2d::Constant(reach_);
    const Eigen::Vector2d from = footprint.centre - reach - lower_;
    const Eigen::Vector2d to = footprint.centre + reach - lower_;
    if ((to.array() < 0.0).any() || (from.array() > (upper_ - lower_).array()).any()) return;
    for (std::size_t row = index(from.y(), rows_); row <= index(to.y(), rows_); ++row)
      for (std::size_t column = index(from.x(), columns_); column <= index(to.x(), columns_); ++column)
        visit(row * columns_ + column);
  }

 private:
  std::size_t index(double offset, std::size_t count) const {
    const double place = offset / cell_;
    if (!(place > 0.0)) return 0;
    return static_cast<std::size_t>(std::min(place, static_cast<double>(count - 1)));
  }

  Eigen::Vector2d lower_;
  Eigen::Vector2d upper_;
  double reach_;
  double cell_ = 1.0;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
};

/// A list, for each cell, of the objects that can matter there. The objects are not copied, and must outlive the lists.
class ThingsInCells {
 public:
  explicit ThingsInCells(const Cells& cells) : first_(cells.count(), none) {}

  void add(const Occupancy::Thing& thing, const Cells& cells) {
    cells.for_each_near(thing.footprint, [&](std::size_t cell) {
      entries_.push_back({&thing, std::exchange(first_[cell], static_cast<std::uint32_t>(entries_.size()))});
    });
  }
  /// Calls `visit` for the objects of a cell until it returns false. Returns true if it never did.
  template <class Visit>
  bool for_each_in(std::size_t cell, Visit&& visit) const {
    for (std::uint32_t entry = first_[cell]; entry != none; entry = entries_[entry].next)
      if (!visit(*entries_[entry].thing)) return false;
    return true;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  struct Entry {
    const Occupancy::Thing* thing;
    std::uint32_t next;
  };
  std::vector<std::uint32_t> first_;  // first entry of each cell
  std::vector<Entry> entries_;
};

}  // namespace cohort::placement
