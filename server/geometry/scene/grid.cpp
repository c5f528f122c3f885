#include "server/geometry/scene/grid.hpp"

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

  items_.assign(items.begin(), items.end());
  entries_.clear();
  if (items.empty()) return;
  extent_ = bounds[items[0]];
  for (const std::uint32_t item : items) extent_.include(bounds[item]);

  // Counting sort into buckets: count, then prefix sums, then insert the items from the last to the first, which leaves
  // the start of each bucket.
  const std::size_t buckets = cells_.choose_buckets(items.size());
  begin_.assign(buckets + 1, 0);
  for (const std::uint32_t item : items) for_each_cell(item, [&](std::size_t bucket) { ++begin_[bucket]; });
  for (std::size_t i = 0; i < buckets; ++i) begin_[i + 1] += begin_[i];
  entries_.resize(begin_[buckets]);
  for (std::size_t i = items.size(); i-- > 0;)
    for_each_cell(items[i], [&](std::size_t bucket) { entries_[--begin_[bucket]] = items[i]; });
}

}  // namespace cohort::geometry
