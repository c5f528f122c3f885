// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "server/core/infinity.hpp"
#include "server/core/integer_floor.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::geometry {

/// The square cells of a uniform grid over the xy plane, stored in a limited number of buckets. Tiles of 8 x 8 cells
/// are hashed, so that neighbouring cells of a tile are near each other in memory and those of a row are contiguous.
class Cells {
 public:
  static constexpr std::int64_t tile_edge = 8;  ///< in cells

  void set_size(double edge) {
    edge_ = edge;
    inverse_ = 1.0 / edge;
  }
  double size() const { return edge_; }  ///< [m]

  /// Returns the index of the column or row that contains a coordinate. For a coordinate beyond the outermost column or
  /// row, or for NaN, returns an outermost index.
  std::int64_t index_of(double coordinate) const { return integer_floor(grid_coordinate(coordinate * inverse_)); }

  /// Returns an upper bound on the number of cells that a rectangle touches; NaN if a bound of it is NaN.
  double most_in(const Bounds& rectangle) const {
    // std::max returns its first argument if that is NaN.
    const double width = std::max(rectangle.upper.x() - rectangle.lower.x(), 0.0);
    const double depth = std::max(rectangle.upper.y() - rectangle.lower.y(), 0.0);
    return (width * inverse_ + 2.0) * (depth * inverse_ + 2.0);
  }

  /// Chooses the number of buckets for this many items and returns it. Different cells may share a bucket.
  std::size_t choose_buckets(std::size_t items) {
    constexpr std::size_t cells_a_tile = tile_edge * tile_edge;
    const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(cells_a_tile, 4 * items));
    mask_ = buckets / cells_a_tile - 1;
    return buckets;
  }
  std::size_t bucket_of(std::int64_t column, std::int64_t row) const {
    const auto x = static_cast<std::uint64_t>(column);
    const auto y = static_cast<std::uint64_t>(row);
    const std::uint64_t hash = (x >> 3) * 0x9e3779b97f4a7c15u ^ (y >> 3) * 0xc2b2ae3d27d4eb4fu;
    return static_cast<std::size_t>(((hash ^ hash >> 29) & mask_) << 6 | (y & 7) << 3 | (x & 7));
  }

  /// Returns how far along a ray of length `range` anything within `extent` can be. Short rays keep their length: they
  /// cross so few cells that the test would cost more.
  double end_of(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range,
                const Bounds& extent) const {
    constexpr double few = 8.0;
    return range > few * edge_ ? std::min(range, extent.last_along(origin, direction)) : range;
  }

  /// Returns whether testing this many items one by one takes no longer than visiting all cells of a rectangle. This
  /// bounds the cost of a search for any cell size and any rectangle.
  bool are_more_than(std::size_t items, const Bounds& rectangle) const {
    return !(most_in(rectangle) <= most_cells_of(items));
  }
  /// Returns the same for visiting all cells along a ray that ends at `end`.
  bool along_are_more_than(std::size_t items, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                           double end) const {
    const double across = std::abs(direction.x()) + std::abs(direction.y());
    if (across == 0.0) return !(end < infinity);  // a search without end in one cell
    return !(end * across * inverse_ <= most_cells_of(items)) || !contains(origin.x()) || !contains(origin.y());
  }

  /// Calls `visit(column, row)` for the cells along a ray of unit direction, near ones first. `visit` returns the
  /// distance at which the search may end, which may decrease from call to call.
  template <class Visit>
  void for_each_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Visit&& visit) const {
    std::int64_t column = index_of(origin.x());
    std::int64_t row = index_of(origin.y());
    const std::int64_t step_x = direction.x() >= 0.0 ? 1 : -1;
    const std::int64_t step_y = direction.y() >= 0.0 ? 1 : -1;
    const double per_cell_x = direction.x() != 0.0 ? edge_ / std::abs(direction.x()) : infinity;
    const double per_cell_y = direction.y() != 0.0 ? edge_ / std::abs(direction.y()) : infinity;
    const auto to_border = [&](double at, std::int64_t index, std::int64_t step, double d) {
      if (d == 0.0) return infinity;
      const double border = static_cast<double>(step > 0 ? index + 1 : index) * edge_;
      return (border - at) / d;
    };
    double next_x = to_border(origin.x(), column, step_x, direction.x());
    double next_y = to_border(origin.y(), row, step_y, direction.y());
    for (;;) {
      const double end = visit(column, row);
      if (!(std::min(next_x, next_y) <= end)) return;
      if (next_x <= next_y) {
        column += step_x;
        next_x += per_cell_x;
      } else {
        row += step_y;
        next_y += per_cell_y;
      }
    }
  }

 private:
  bool contains(double coordinate) const { return grid_coordinate(coordinate * inverse_) == coordinate * inverse_; }
  static double most_cells_of(std::size_t items) {
    constexpr double few = 64.0;
    return few + static_cast<double>(items);
  }

  double edge_ = 1.0;
  double inverse_ = 1.0;
  std::uint64_t mask_ = 0;  // mask of the hash of tiles
};

}  // namespace cohort::geometry
