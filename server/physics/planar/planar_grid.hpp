// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "server/core/integer_floor.hpp"

namespace cohort::physics {

/// Discs in the plane, in an unbounded hashed grid, each in the cell of its centre. The cells of a row, and the discs
/// in them, are contiguous in memory: a search reads three short ranges. Built at once; threads may then query it
/// concurrently.
class PlanarGrid {
 public:
  struct Disc {
    double x = 0.0;
    double y = 0.0;
    double radius = 0.0;
    std::uint32_t item = 0;
  };

  /// Builds the grid; equal input gives an equal grid, regardless of its earlier content.
  void build(std::span<const Disc> discs);

  /// Calls `visit(item)` once for each disc nearer to `disc` than `margin`, including itself.
  template <class Visit>
  void for_each_near(const Disc& disc, double margin, Visit&& visit) const {
    // The sum of any two radii is at most the width of a cell.
    const std::int64_t column = cell_of(disc.x - margin);
    const std::int64_t last_column = cell_of(disc.x + margin) + 1;
    const std::int64_t row = cell_of(disc.y - margin);
    const std::int64_t last_row = cell_of(disc.y + margin) + 1;
    for (std::int64_t y = row - 1; y <= last_row; ++y) {
      for (std::int64_t x = column - 1; x <= last_column; ++x) {
        const std::size_t bucket = bucket_of(x, y);
        for (std::uint32_t i = begin_[bucket]; i < begin_[bucket + 1]; ++i) {
          const Entry& entry = entries_[i];
          const double reach = disc.radius + entry.disc.radius + margin;
          const double dx = entry.disc.x - disc.x;
          const double dy = entry.disc.y - disc.y;
          // Other cells may share the bucket.
          if (dx * dx + dy * dy < reach * reach && entry.column == x && entry.row == y) visit(entry.disc.item);
        }
      }
    }
  }

 private:
  struct Entry {
    Disc disc;
    std::int64_t column = 0;
    std::int64_t row = 0;
  };
  std::int64_t cell_of(double at) const { return integer_floor(grid_coordinate(at * inverse_)); }
  std::size_t bucket_of(std::int64_t column, std::int64_t row) const {
    const auto start = static_cast<std::uint64_t>(row) * 0x9e3779b97f4a7c15u >> 20;
    return static_cast<std::size_t>((start + static_cast<std::uint64_t>(column)) & mask_);
  }

  double inverse_ = 1.0;  // 1 / width of a cell [1/m]
  std::uint64_t mask_ = 0;
  std::vector<std::uint32_t> begin_;  // start of each bucket in entries_, and one past the last
  std::vector<Entry> entries_;        // in the order of discs within a bucket
  std::vector<std::uint32_t> bucket_of_disc_;
};

}  // namespace cohort::physics
