// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>

#include "tools/common/drawing/run_trace.hpp"

/// The layout of a plot on the page. The viewer's frame has x to the right and y upwards [m]. On the page, y points
/// downwards; its unit is a CSS pixel when the picture is shown at its own size.
namespace cohort::tool {

/// A rectangle of the world [m].
struct Range {
  Eigen::Vector2d lower = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d upper = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(lower.array() <= upper.array()).all(); }
  Eigen::Vector2d size() const { return upper - lower; }
  void add(const Eigen::Vector2d& point, double around = 0.0) {
    lower = lower.cwiseMin(Eigen::Vector2d(point.array() - around));
    upper = upper.cwiseMax(Eigen::Vector2d(point.array() + around));
  }
};

/// Returns the visible range of a run, which is never empty.
Range range_of(const RunTrace& trace);

/// The transform from the world to the page.
struct View {
  static constexpr double longest_side = 600.0;
  static constexpr double shortest_side = 236.0;  ///< the legend is beside it

  Range range_V;
  double scale;            ///< page units of a metre
  Eigen::Vector2d origin;  ///< upper left corner of the map on the page
  Eigen::Vector2d size;    ///< size of the map

  /// Fits `range` into the map; a long corridor is shown with some of the world on both sides.
  explicit View(const Range& range);

  Eigen::Vector2d operator()(const Eigen::Vector2d& point_V) const {
    return {origin.x() + scale * (point_V.x() - range_V.lower.x()),
            origin.y() + scale * (range_V.upper.y() - point_V.y())};
  }
};

/// Returns the largest of 1, 2 and 5 times a power of ten that is at most `length`.
double round_length(double length);

/// The multiples `first` to `last` of `step` between two coordinates [m].
struct Ticks {
  Ticks(double lower, double upper, double its_step);
  double at(std::int64_t index) const { return static_cast<double>(index) * step; }
  std::string label(std::int64_t index) const;

  double step;
  std::int64_t first;
  std::int64_t last;
  int decimals;
};

}  // namespace cohort::tool
