#include "server/geometry/scene/corner_grid.hpp"

namespace cohort::geometry {

void CornerGrid::build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds) {
  entries_.clear();
  if (items.empty()) return;
  extent_ = bounds[items[0]];
  for (const std::uint32_t item : items) extent_.include(bounds[item]);

  // Counting sort into buckets: count, then prefix sums, then insert the items from the last to the first, which leaves
  // the start of each bucket.
  const std::size_t buckets = cells_.choose_buckets(items.size());
  begin_.assign(buckets + 1, 0);
  buckets_.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Eigen::Vector3d& corner = bounds[items[i]].lower;
    const std::size_t bucket = cells_.bucket_of(cells_.index_of(corner.x()), cells_.index_of(corner.y()));
    buckets_[i] = static_cast<std::uint32_t>(bucket);
    ++begin_[bucket];
  }
  for (std::size_t i = 0; i < buckets; ++i) begin_[i + 1] += begin_[i];
  entries_.resize(items.size());
  for (std::size_t i = items.size(); i-- > 0;) entries_[--begin_[buckets_[i]]] = {bounds[items[i]], items[i]};
}

}  // namespace cohort::geometry
