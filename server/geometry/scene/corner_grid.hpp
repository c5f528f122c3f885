// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "server/geometry/scene/cells.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::geometry {

/// A uniform grid over the xy plane, hashed and therefore unbounded, for items that are no wider than a cell. Each item
/// is stored with its bounds, only in the cell of their lower corner; a query reads a few short ranges of memory. Built
/// at once; threads may then query it concurrently.
class CornerGrid {
 public:
  void set_cell_size(double edge) { cells_.set_size(edge); }
  double cell_size() const { return cells_.size(); }

  /// Builds the grid. `items`: indices. An item that is wider than a cell along x or y, or not finite, is in no cell:
  /// every search visits it. Equal input gives an equal grid, regardless of its earlier content.
  void build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds);

  /// Calls `visit(item)` once for each item whose bounds overlap `query`, in an order that depends only on the content
  /// of the grid. The query may be infinite.
  template <class Visit>
  void for_each_overlap(const Bounds& query, Visit&& visit) const {
    for (const Entry& entry : apart_)
      if (query.overlaps(entry.bounds)) visit(entry.item);
    if (entries_.empty()) return;
    const Bounds within{query.lower.cwiseMax(extent_.lower), query.upper.cwiseMin(extent_.upper)};
    if (cells_.are_more_than(entries_.size(), within)) {
      for (const Entry& entry : entries_)
        if (query.overlaps(entry.bounds)) visit(entry.item);
      return;
    }
    const std::int64_t first = cells_.index_of(within.lower.x()) - 1;
    const std::int64_t last = cells_.index_of(within.upper.x());
    const std::int64_t last_row = cells_.index_of(within.upper.y());
    for (std::int64_t row = cells_.index_of(within.lower.y()) - 1; row <= last_row; ++row) {
      for_each_in_row(first, last, row, [&](const Entry& entry) {
        if (!query.overlaps(entry.bounds)) return;
        // Another cell of the query may share the bucket.
        const std::int64_t column = cells_.index_of(entry.bounds.lower.x());
        if (column >= first && column <= last && cells_.index_of(entry.bounds.lower.y()) == row) visit(entry.item);
      });
    }
  }

  /// Calls `visit(item)` for all items that may be on a ray of unit direction, near ones first, some more than once.
  /// Visits all items if the ray is long for cells of this size. `visit` returns the distance at which the search may
  /// end, which may decrease from call to call. `range` may be infinite.
  template <class Visit>
  void for_each_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range,
                      Visit&& visit) const {
    for (const Entry& entry : apart_) range = std::min(range, visit(entry.item));
    if (entries_.empty()) return;
    double end = cells_.end_of(origin, direction, range, extent_);
    if (cells_.along_are_more_than(entries_.size(), origin, direction, end)) {
      for (const Entry& entry : entries_) visit(entry.item);
      return;
    }
    cells_.for_each_along(origin, direction, [&](std::int64_t column, std::int64_t row) {
      for (const std::int64_t of_corners : {row - 1, row})
        for_each_in_row(column - 1, column, of_corners,
                        [&](const Entry& entry) { end = std::min(end, visit(entry.item)); });
      return end;
    });
  }

 private:
  static constexpr std::uint32_t no_bucket = 0xffffffffu;

  struct Entry {
    Bounds bounds;
    std::uint32_t item = 0;
  };

  // Visits all items in the buckets of these cells.
  template <class Visit>
  void for_each_in_row(std::int64_t first, std::int64_t last, std::int64_t row, Visit&& visit) const {
    while (first <= last) {
      const std::int64_t last_in_tile = std::min(last, first | (Cells::tile_edge - 1));
      const std::size_t bucket = cells_.bucket_of(first, row);
      const std::uint32_t end = begin_[bucket + static_cast<std::size_t>(last_in_tile - first) + 1];
      for (std::uint32_t i = begin_[bucket]; i < end; ++i) visit(entries_[i]);
      first = last_in_tile + 1;
    }
  }

  Cells cells_;
  std::vector<std::uint32_t> begin_;  // start of each bucket in entries_, and one past the last
  std::vector<Entry> entries_;
  std::vector<Entry> apart_;                                         // items in no cell
  Bounds extent_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // bounds of all entries
  std::vector<std::uint32_t> buckets_;                               // buckets of the items, used while building
};

}  // namespace cohort::geometry
