#include "server/geometry/grid.hpp"

#include <bit>

namespace cohort::geometry {
namespace {

constexpr std::size_t cells_a_tile = 64;

}  // namespace

double Grid::cells_covered(const Bounds& bounds) const {
  const double width = std::floor((bounds.upper.x() - bounds.lower.x()) * inverse_) + 2.0;
  const double depth = std::floor((bounds.upper.y() - bounds.lower.y()) * inverse_) + 2.0;
  return width * depth;
}

void Grid::build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds) {
  const auto for_each_cell = [&](std::uint32_t item, auto&& act) {
    const Cell lower = cell_at(bounds[item].lower.x(), bounds[item].lower.y());
    const Cell upper = cell_at(bounds[item].upper.x(), bounds[item].upper.y());
    for (std::int64_t y = lower.y; y <= upper.y; ++y)
      for (std::int64_t x = lower.x; x <= upper.x; ++x) act(bucket_of({x, y}));
  };

  // Counting sort into buckets: sizes, then ends, then items from the last to the first, which leaves the beginnings.
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(cells_a_tile, 4 * items.size()));
  mask_ = buckets / cells_a_tile - 1;
  begin_.assign(buckets + 1, 0);
  for (const std::uint32_t item : items) for_each_cell(item, [&](std::size_t bucket) { ++begin_[bucket]; });
  for (std::size_t i = 0; i < buckets; ++i) begin_[i + 1] += begin_[i];
  entries_.resize(begin_[buckets]);
  for (auto item = items.rbegin(); item != items.rend(); ++item)
    for_each_cell(*item, [&](std::size_t bucket) { entries_[--begin_[bucket]] = *item; });
}

}  // namespace cohort::geometry
