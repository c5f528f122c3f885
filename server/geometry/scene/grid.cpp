// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/scene/grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cohort::geometry {

double Grid::cells_covered(const Bounds& bounds) const {
  const double width = std::floor((bounds.upper.x() - bounds.lower.x()) / cells_.size()) + 2.0;
  const double depth = std::floor((bounds.upper.y() - bounds.lower.y()) / cells_.size()) + 2.0;
  return width * depth;
}

void Grid::build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds) {
  const auto for_each_cell = [&](std::uint32_t item, auto&& act) {
    const std::int64_t last = cells_.index_of(bounds[item].upper.x());
    const std::int64_t last_row = cells_.index_of(bounds[item].upper.y());
    for (std::int64_t row = cells_.index_of(bounds[item].lower.y()); row <= last_row; ++row)
      for (std::int64_t column = cells_.index_of(bounds[item].lower.x()); column <= last; ++column)
        act(cells_.bucket_of(column, row));
  };

  items_.clear();
  apart_.clear();
  entries_.clear();
  for (const std::uint32_t item : items)
    (cells_.most_in(bounds[item]) <= most_cells_an_item ? items_ : apart_).push_back(item);
  if (items_.empty()) return;
  extent_ = bounds[items_[0]];
  for (const std::uint32_t item : items_) extent_.include(bounds[item]);

  // Counting sort into buckets: count, then prefix sums, then insert the items from the last to the first, which leaves
  // the start of each bucket.
  const std::size_t buckets = cells_.choose_buckets(items_.size());
  begin_.assign(buckets + 1, 0);
  for (const std::uint32_t item : items_) for_each_cell(item, [&](std::size_t bucket) { ++begin_[bucket]; });
  for (std::size_t i = 0; i < buckets; ++i) begin_[i + 1] += begin_[i];
  entries_.resize(begin_[buckets]);
  assert(std::ranges::is_sorted(items));
  for (std::size_t i = items_.size(); i-- > 0;)
    for_each_cell(items_[i], [&](std::size_t bucket) { entries_[--begin_[bucket]] = items_[i]; });
  assert(begin_.front() == 0 && begin_.back() == entries_.size());
}

}  // namespace cohort::geometry
