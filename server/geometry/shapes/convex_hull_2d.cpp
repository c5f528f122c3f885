// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/convex_hull_2d.hpp"

#include <algorithm>
#include <utility>

namespace cohort::geometry {

std::vector<Eigen::Vector2d> convex_hull_2d(std::vector<Eigen::Vector2d> points) {
  std::ranges::sort(points, {}, [](const Eigen::Vector2d& point) { return std::pair(point.x(), point.y()); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  // Build the lower hull forwards, then the upper hull backwards.
  std::vector<Eigen::Vector2d> hull;
  const auto add = [&](const Eigen::Vector2d& point, std::size_t fixed) {
    while (hull.size() > fixed) {
      const Eigen::Vector2d last = hull.back() - hull[hull.size() - 2];
      const Eigen::Vector2d next = point - hull.back();
      if (last.x() * next.y() - last.y() * next.x() > 0.0) break;
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Eigen::Vector2d& point : points) add(point, 1);
  const std::size_t there = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], there);
  hull.pop_back();
  return hull;
}

}  // namespace cohort::geometry
