#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "server/core/floor.hpp"
#include "server/geometry/shapes.hpp"

namespace cohort::geometry {

/// A uniform grid over the xy plane, hashed, so that it has no edge. Holds items by index, each in every cell that its
/// bounds touch. Built at once; queries may then run from any thread.
class Grid {
 public:
  struct Cell {
    std::int64_t x;
    std::int64_t y;
    friend bool operator==(const Cell&, const Cell&) = default;
  };

  void set_cell_size(double edge) {
    edge_ = edge;
    inverse_ = 1.0 / edge;
  }
  double cell_size() const { return edge_; }

  /// Cells that `bounds` touches; more than any grid should hold if it is very large.
  double cells_covered(const Bounds& bounds) const;

  /// `items`: indices; `bounds[item]` must be finite. Equal input gives an equal grid, whatever was in it before.
  void build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds);

  /// Calls `visit(item)` once for each item of the grid whose bounds overlap `query`, in an order that depends on the
  /// grid's content alone.
  template <class Visit>
  void for_each_overlap(const Bounds& query, const std::vector<Bounds>& bounds, Visit&& visit) const {
    if (entries_.empty()) return;
    const Cell lower = cell_at(query.lower.x(), query.lower.y());
    const Cell upper = cell_at(query.upper.x(), query.upper.y());
    for (std::int64_t y = lower.y; y <= upper.y; ++y)
      for (std::int64_t x = lower.x; x <= upper.x; ++x) {
        const std::span<const std::uint32_t> items = bucket({x, y});
        for (std::size_t i = 0; i < items.size(); ++i) {
          const std::uint32_t item = items[i];
          if (i > 0 && items[i - 1] == item) continue;  // two of its cells fell into this bucket
          const Bounds& other = bounds[item];
          if (!query.overlaps(other)) continue;
          // Of the cells that both touch, the lowest one reports.
          const Cell first =
              cell_at(std::max(query.lower.x(), other.lower.x()), std::max(query.lower.y(), other.lower.y()));
          if (first == Cell{x, y}) visit(item);
        }
      }
  }

  /// Calls `visit(item)` for the items of the cells along a ray, near cells first, some items more than once.
  /// `visit` returns how far along the ray the search may end, which may shrink from call to call.
  template <class Visit>
  void for_each_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range,
                      Visit&& visit) const {
    if (entries_.empty()) return;
    const double infinity = std::numeric_limits<double>::infinity();
    Cell cell = cell_at(origin.x(), origin.y());
    const std::int64_t step_x = direction.x() >= 0.0 ? 1 : -1;
    const std::int64_t step_y = direction.y() >= 0.0 ? 1 : -1;
    const double per_cell_x = direction.x() != 0.0 ? edge_ / std::abs(direction.x()) : infinity;
    const double per_cell_y = direction.y() != 0.0 ? edge_ / std::abs(direction.y()) : infinity;
    const auto to_border = [&](double at, std::int64_t index, std::int64_t step, double d) {
      if (d == 0.0) return infinity;
      const double border = static_cast<double>(step > 0 ? index + 1 : index) * edge_;
      return (border - at) / d;
    };
    double next_x = to_border(origin.x(), cell.x, step_x, direction.x());
    double next_y = to_border(origin.y(), cell.y, step_y, direction.y());
    double end = range;
    for (;;) {
      for (const std::uint32_t item : bucket(cell)) end = visit(item);
      const double next = std::min(next_x, next_y);
      if (!(next <= end)) return;
      if (next_x <= next_y) {
        cell.x += step_x;
        next_x += per_cell_x;
      } else {
        cell.y += step_y;
        next_y += per_cell_y;
      }
    }
  }

 private:
  Cell cell_at(double x, double y) const {
    return {integer_below(x * inverse_), integer_below(y * inverse_)};
  }
  // Tiles of 8 x 8 cells are hashed, so that cells side by side are so in memory.
  std::size_t bucket_of(Cell cell) const {
    const auto x = static_cast<std::uint64_t>(cell.x);
    const auto y = static_cast<std::uint64_t>(cell.y);
    const std::uint64_t hash = (x >> 3) * 0x9e3779b97f4a7c15u ^ (y >> 3) * 0xc2b2ae3d27d4eb4fu;
    return static_cast<std::size_t>(((hash ^ hash >> 29) & mask_) << 6 | (y & 7) << 3 | (x & 7));
  }
  std::span<const std::uint32_t> bucket(Cell cell) const {
    const std::size_t index = bucket_of(cell);
    return {entries_.data() + begin_[index], entries_.data() + begin_[index + 1]};
  }

  double edge_ = 1.0;
  double inverse_ = 1.0;
  std::uint64_t mask_ = 0;              // of the tiles
  std::vector<std::uint32_t> begin_;    // of each bucket in entries_, and one past the last
  std::vector<std::uint32_t> entries_;  // items, ascending within a bucket
};

}  // namespace cohort::geometry
