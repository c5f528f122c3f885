// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "server/geometry/scene/cells.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::geometry {

/// A uniform grid over the xy plane, hashed and therefore unbounded. Holds items by index, each in every cell that its
/// bounds touch. Built at once; threads may then query it concurrently.
class Grid {
 public:
  void set_cell_size(double edge) { cells_.set_size(edge); }

  /// Returns the number of cells that `bounds` touches; for very large bounds, it exceeds what a grid should hold. NaN
  /// if a bound is NaN.
  double cells_covered(const Bounds& bounds) const;

  /// Builds the grid. `items`: indices. An item that would fill very many cells, or is not finite, is in no cell: every
  /// search visits it. Equal input gives an equal grid, regardless of its earlier content.
  void build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds);

  /// Calls `visit(item)` once for each item of the grid whose bounds overlap `query`, in an order that depends only on
  /// the content of the grid.
  template <class Visit>
  void for_each_overlap(const Bounds& query, const std::vector<Bounds>& bounds, Visit&& visit) const {
    for (const std::uint32_t item : apart_)
      if (query.overlaps(bounds[item])) visit(item);
    if (entries_.empty()) return;
    if (cells_.are_more_than(items_.size(), query)) {
      for (const std::uint32_t item : items_)
        if (query.overlaps(bounds[item])) visit(item);
      return;
    }
    const std::int64_t first = cells_.index_of(query.lower.x());
    const std::int64_t last = cells_.index_of(query.upper.x());
    const std::int64_t first_row = cells_.index_of(query.lower.y());
    const std::int64_t last_row = cells_.index_of(query.upper.y());
    for (std::int64_t row = first_row; row <= last_row; ++row)
      for (std::int64_t column = first; column <= last; ++column) {
        const std::span<const std::uint32_t> items = bucket(column, row);
        for (std::size_t i = 0; i < items.size(); ++i) {
          const std::uint32_t item = items[i];
          if (i > 0 && items[i - 1] == item) continue;  // two of its cells fell into this bucket
          const Bounds& other = bounds[item];
          if (!query.overlaps(other)) continue;
          // The lowest cell that both touch reports the item.
          if (std::max(first, cells_.index_of(other.lower.x())) == column &&
              std::max(first_row, cells_.index_of(other.lower.y())) == row)
            visit(item);
        }
      }
  }

  /// Calls `visit(item)` for the items of the cells along a ray, near cells first, some items more than once. Visits
  /// all items if the ray is long for cells of this size. `visit` returns the distance at which the search may end,
  /// which may decrease from call to call. `range` may be infinite.
  template <class Visit>
  void for_each_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range,
                      Visit&& visit) const {
    for (const std::uint32_t item : apart_) range = std::min(range, visit(item));
    if (entries_.empty()) return;
    double end = cells_.end_of(origin, direction, range, extent_);
    if (cells_.along_are_more_than(items_.size(), origin, direction, end)) {
      for (const std::uint32_t item : items_) visit(item);
      return;
    }
    cells_.for_each_along(origin, direction, [&](std::int64_t column, std::int64_t row) {
      for (const std::uint32_t item : bucket(column, row)) end = std::min(end, visit(item));
      return end;
    });
  }

 private:
  static constexpr double most_cells_an_item = 256.0;  // Scene never adds an item with so many cells

  std::span<const std::uint32_t> bucket(std::int64_t column, std::int64_t row) const {
    const std::size_t index = cells_.bucket_of(column, row);
    return {entries_.data() + begin_[index], entries_.data() + begin_[index + 1]};
  }

  Cells cells_;
  std::vector<std::uint32_t> begin_;    // start of each bucket in entries_, and one past the last
  std::vector<std::uint32_t> entries_;  // items, ascending within a bucket
  std::vector<std::uint32_t> items_;    // those in cells, each once
  std::vector<std::uint32_t> apart_;    // those in no cell
  Bounds extent_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // bounds of the items in cells
};

}  // namespace cohort::geometry
