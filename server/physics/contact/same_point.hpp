// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace cohort::physics {

/// A contact point that moves less than this between two steps counts as the same point [m].
inline constexpr double same_point = 0.01;

/// Calls `take_over(old, point)` for each point of `now` near a point of the last step: the nearest one not yet taken.
/// Points are matched by position, because rounding may change which corner a point belongs to.
template <class Points, class TakeOver>
void match_points(const Points& before, Points& now, TakeOver&& take_over) {
  std::array<bool, Points::most> taken{};
  for (auto& point : now) {
    double nearest = same_point * same_point;
    int best = -1;
    for (int i = 0; i < before.count; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const double distance = (before.points[index].position_W - point.position_W).squaredNorm();
      if (taken[index] || distance >= nearest) continue;
      nearest = distance;
      best = i;
    }
    if (best < 0) continue;
    const auto index = static_cast<std::size_t>(best);
    taken[index] = true;
    take_over(before.points[index], point);
  }
}

}  // namespace cohort::physics
