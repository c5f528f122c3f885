// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_grid.hpp"

#include <algorithm>
#include <bit>

namespace cohort::physics {

void PlanarGrid::build(std::span<const Disc> discs) {
  constexpr double narrowest = 0.02;  // so that a margin spans few cells [m]
  double widest = narrowest;
  for (const Disc& disc : discs) widest = std::max(widest, 2.0 * disc.radius);
  inverse_ = 1.0 / widest;
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(16, 2 * discs.size()));
  mask_ = buckets - 1;

  // Counting sort into buckets: count, then prefix sums, then insert the discs from the last to the first.
  begin_.assign(buckets + 1, 0);
  bucket_of_disc_.resize(discs.size());
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const std::size_t bucket = bucket_of(cell_of(discs[i].x), cell_of(discs[i].y));
    bucket_of_disc_[i] = static_cast<std::uint32_t>(bucket);
    ++begin_[bucket];
  }
  for (std::size_t i = 0; i < buckets; ++i) begin_[i + 1] += begin_[i];
  entries_.resize(discs.size());
  for (std::size_t i = discs.size(); i-- > 0;)
    entries_[--begin_[bucket_of_disc_[i]]] = {discs[i], cell_of(discs[i].x), cell_of(discs[i].y)};
}

}  // namespace cohort::physics
