#pragma once

#include <array>
#include <cstddef>

namespace cohort::physics {

/// A point of contact may move this far from one step to the next and still be the same [m].
inline constexpr double same_point = 0.01;

/// Calls `take_over(old, point)` for each point of `now` that has one of the last step near it: the nearest that is
/// left. Whose corner a point is may change by rounding; where it is does not.
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
