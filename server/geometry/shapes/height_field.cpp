// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/height_field.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "server/core/infinity.hpp"
#include "server/core/integer_floor.hpp"
#include "server/core/is_unit.hpp"

namespace cohort::geometry {
namespace {

using description::HeightGrid;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// The plane of one of the two triangles of a cell.
struct Slope {
  Vector2d at;  // a corner
  double height;
  Vector2d gradient;

  double below(const Vector3d& point) const { return height + gradient.dot(point.head<2>() - at); }
  Vector3d normal() const { return Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized(); }
};

/// A traversal of the cells below or above a ray.
class Walk {
 public:
  Walk(const HeightGrid& grid, const Vector3d& origin, const Vector3d& direction)
      : grid_(grid), origin_(origin), direction_(direction), half_(grid.half_size()) {
    assert(is_unit(direction));
  }

  RayEntry enter(double range) {
    double first = 0.0;
    double last = range;
    int side = -1;  // axis across which the ray enters the grid; -1 if it starts within
    for (int axis = 0; axis < 2; ++axis) {
      if (direction_[axis] == 0.0) {
        if (std::abs(origin_[axis]) > half_[axis]) return {};
        continue;
      }
      const double a = (-half_[axis] - origin_[axis]) / direction_[axis];
      const double b = (half_[axis] - origin_[axis]) / direction_[axis];
      if (std::min(a, b) > first) {
        first = std::min(a, b);
        side = axis;
      }
      last = std::min(last, std::max(a, b));
    }
    if (first > last) return {};
    start(first);
    const Slope slope = slope_at(at(first));
    if (at(first).z() <= slope.below(at(first))) {
      if (side < 0) return {0.0, Vector3d::Zero()};
      Vector3d normal = Vector3d::Zero();
      normal[side] = direction_[side] > 0.0 ? -1.0 : 1.0;
      return {first, normal};
    }
    return walk(first, last);
  }

 private:
  Vector3d at(double distance) const { return origin_ + distance * direction_; }

  double border(int axis, std::int64_t line) const {
    return static_cast<double>(line) * grid_.spacing[axis] - half_[axis];
  }

  // Starts in the cell that contains the point at this distance, or in the nearest one if rounding puts the point
  // outside the grid.
  void start(double distance) {
    const Vector3d point = at(distance);
    const std::int64_t most[] = {static_cast<std::int64_t>(grid_.columns) - 2,
                                 static_cast<std::int64_t>(grid_.rows) - 2};
    for (int axis = 0; axis < 2; ++axis)
      cell_[axis] =
          std::clamp(integer_floor((point[axis] + half_[axis]) / grid_.spacing[axis]), std::int64_t{0}, most[axis]);
  }

  // Returns the distance at which the ray reaches the next grid line across this axis.
  double to_line(int axis) const {
    if (direction_[axis] == 0.0) return infinity;
    return (border(axis, cell_[axis] + (direction_[axis] > 0.0 ? 1 : 0)) - origin_[axis]) / direction_[axis];
  }

  Vector2d corner() const { return {border(0, cell_[0]), border(1, cell_[1])}; }

  double corner_height(int right, int up) const {
    return grid_.height(static_cast<std::size_t>(cell_[0] + right), static_cast<std::size_t>(cell_[1] + up));
  }

  // Returns a value > 0 beyond the diagonal of the cell, seen from its lower left corner.
  double beyond_diagonal(const Vector3d& point) const {
    return (point.head<2>() - corner()).cwiseQuotient(grid_.spacing).sum() - 1.0;
  }

  Slope slope_at(const Vector3d& point) const {
    const double lower_right = corner_height(1, 0);
    const double upper_left = corner_height(0, 1);
    if (beyond_diagonal(point) <= 0.0) {
      const double height = corner_height(0, 0);
      return {corner(), height, Vector2d(lower_right - height, upper_left - height).cwiseQuotient(grid_.spacing)};
    }
    const double height = corner_height(1, 1);
    return {corner() + grid_.spacing, height,
            Vector2d(height - upper_left, height - lower_right).cwiseQuotient(grid_.spacing)};
  }

  RayEntry walk(double first, double last) {
    for (;;) {
      const double next = std::min({to_line(0), to_line(1), last});
      const double diagonal = to_diagonal();
      if (diagonal > first && diagonal < next) {
        if (RayEntry entry = enter_slope(first, diagonal); std::isfinite(entry.distance)) return entry;
        first = diagonal;
      }
      if (RayEntry entry = enter_slope(first, next); std::isfinite(entry.distance)) return entry;
      if (next >= last) return {};
      first = std::max(first, next);
      const int axis = to_line(0) <= to_line(1) ? 0 : 1;
      cell_[axis] += direction_[axis] > 0.0 ? 1 : -1;
      const auto lines = static_cast<std::int64_t>(axis == 0 ? grid_.columns : grid_.rows);
      if (cell_[axis] < 0 || cell_[axis] > lines - 2) return {};
    }
  }

  double to_diagonal() const {
    const double speed = direction_.head<2>().cwiseQuotient(grid_.spacing).sum();
    return speed == 0.0 ? infinity : -beyond_diagonal(origin_) / speed;
  }

  // Returns where the ray enters one triangle between two distances.
  RayEntry enter_slope(double from, double to) const {
    const Slope slope = slope_at(at(std::isfinite(to) ? 0.5 * (from + to) : from));
    const double height = at(from).z() - slope.below(at(from));
    if (height <= 0.0) return {from, slope.normal()};
    const double climb = direction_.z() - slope.gradient.dot(direction_.head<2>());
    if (climb >= 0.0) return {};
    const double distance = from + height / -climb;
    return distance <= to ? RayEntry{distance, slope.normal()} : RayEntry{};
  }

  const HeightGrid& grid_;
  const Vector3d& origin_;
  const Vector3d& direction_;
  Vector2d half_;
  std::int64_t cell_[2] = {0, 0};  // column and row
};

}  // namespace

Bounds bounds_of(const HeightGrid& grid, const Pose& X_WC) {
  Bounds bounds{Vector3d::Constant(infinity), Vector3d::Constant(-infinity)};
  const Vector2d half = grid.half_size();
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const Vector3d point_C(static_cast<double>(column) * grid.spacing.x() - half.x(),
                             static_cast<double>(row) * grid.spacing.y() - half.y(), grid.height(column, row));
      const Vector3d point_W = X_WC * point_C;
      bounds.lower = bounds.lower.cwiseMin(point_W);
      bounds.upper = bounds.upper.cwiseMax(point_W);
    }
  constexpr double upright = 1e-9;  // a smaller tilt is rounding
  const Vector3d up_W = X_WC.orientation * Vector3d::UnitZ();
  for (int axis = 0; axis < 3; ++axis) {
    if (up_W[axis] > upright) bounds.lower[axis] = -infinity;
    if (up_W[axis] < -upright) bounds.upper[axis] = infinity;
  }
  return bounds;
}

RayEntry cast_ray(const HeightGrid& grid, const Vector3d& origin, const Vector3d& direction, double range) {
  return Walk(grid, origin, direction).enter(range);
}

}  // namespace cohort::geometry
