// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/scene/corner_grid.hpp"

namespace cohort::geometry {

void CornerGrid::build(std::span<const std::uint32_t> items, const std::vector<Bounds>& bounds) {
  entries_.clear();
  apart_.clear();
  if (items.empty()) return;
  const double widest = cells_.size() * (1.0 + 1e-6);  // with the rounding of coordinates
  const auto is_apart = [&](std::uint32_t item) {
    const Bounds& its = bounds[item];
    return !(its.upper.x() - its.lower.x() <= widest && its.upper.y() - its.lower.y() <= widest);  // also NaN
  };
  const auto first = std::ranges::find_if_not(items, is_apart);
  if (first != items.end()) extent_ = bounds[*first];

  // Counting sort into buckets: count, then prefix sums, then insert the items from the last to the first, which leaves
  // the start of each bucket.
  const std::size_t buckets = cells_.choose_buckets(items.size());
  begin_.assign(buckets + 1, 0);
  buckets_.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (is_apart(items[i])) {
      apart_.push_back({bounds[items[i]], items[i]});
      buckets_[i] = no_bucket;
      continue;
    }
    extent_.include(bounds[items[i]]);
    const Eigen::Vector3d& corner = bounds[items[i]].lower;
    const std::size_t bucket = cells_.bucket_of(cells_.index_of(corner.x()), cells_.index_of(corner.y()));
    buckets_[i] = static_cast<std::uint32_t>(bucket);
    ++begin_[bucket];
  }
  for (std::size_t i = 0; i < buckets; ++i) begin_[i + 1] += begin_[i];
  entries_.resize(items.size() - apart_.size());
  for (std::size_t i = items.size(); i-- > 0;)
    if (buckets_[i] != no_bucket) entries_[--begin_[buckets_[i]]] = {bounds[items[i]], items[i]};
}

}  // namespace cohort::geometry
