// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/plot_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "server/geometry/shapes/shapes.hpp"

namespace cohort::tool {

Range range_of(const RunTrace& trace) {
  Range range;
  const auto add_solids = [&](bool floors) {
    for (const TracedSolid& solid : trace.solids) {
      if ((solid.kind == TracedSolid::Kind::floor) != floors) continue;
      const geometry::Bounds bounds = geometry::bounds_of(solid.shape, solid.X_VC);
      range.add(bounds.lower.head<2>());
      range.add(bounds.upper.head<2>());
    }
  };
  for (const RobotTrace& robot : trace.robots)
    for (const Eigen::Vector2d& point_V : robot.path_V) range.add(point_V, robot.radius);
  add_solids(false);
  if (range.empty()) add_solids(true);
  if (range.empty()) range.add(Eigen::Vector2d::Zero());

  // If a robot hardly moves in an empty world, some of the surrounding world is shown from above.
  double largest_robot = 0.0;
  for (const RobotTrace& robot : trace.robots) largest_robot = std::max(largest_robot, robot.radius);
  const double least_size = largest_robot > 0.0 ? 12.0 * largest_robot : 1.0;
  const Eigen::Vector2d centre = (range.lower + range.upper) / 2.0;
  if (trace.viewpoint == Viewpoint::above && range.size().maxCoeff() < least_size) range.add(centre, least_size / 2.0);
  const double border = 0.025 * range.size().maxCoeff();
  range.lower.array() -= border;
  range.upper.array() += border;
  return range;
}

View::View(const Range& range)
    : range_V(range), scale(longest_side / range.size().maxCoeff()), origin(Eigen::Vector2d::Zero()) {
  const Eigen::Vector2d least = Eigen::Vector2d::Constant(shortest_side / scale);
  const Eigen::Vector2d missing = (least - range.size()).cwiseMax(0.0);
  range_V.lower -= missing / 2.0;
  range_V.upper += missing / 2.0;
  size = scale * range_V.size();
}

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= length) return factor * power;
  return power;
}

Ticks::Ticks(double lower, double upper, double its_step)
    : step(its_step),
      first(std::llround(std::ceil(lower / step - 1e-9))),
      last(std::llround(std::floor(upper / step + 1e-9))),
      decimals(std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)))) {}

std::string Ticks::label(std::int64_t index) const { return fmt::format("{:.{}f}", at(index), decimals); }

}  // namespace cohort::tool
