// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/panorama.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "server/core/infinity.hpp"
#include "server/core/integer_floor.hpp"
#include "server/core/plane_vectors.hpp"
#include "server/geometry/visibility/rounding.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr double angle_slack = 1e-9;  // more than the rounding of an angle [rad]

}  // namespace

/// The pixels that a solid may cover: rows, and columns from `first_column` on, which wrap around.
struct Panorama::Window {
  double nearest = 0.0;  // least distance of its points [m]
  std::uint32_t solid = 0;
  std::size_t first_column = 0;
  std::size_t columns = 0;
  std::size_t first_row = 0;
  std::size_t last_row = 0;  // one past
};

struct Panorama::View {
  Pose X_WS;
  Pose X_SW;
  double range;
};

namespace {

/// The bearings and elevations at which a solid is seen, in the frame S. By default, all.
struct Extent {
  double nearest = 0.0;
  double first_bearing = 0.0;
  double last_bearing = 2.0 * pi;
  double least_elevation = -pi;
  double most_elevation = pi;
};

Extent extent_of(const Scene::Ball& ball, const Pose& X_SW) {
  Extent extent;
  const Vector3d centre_S = X_SW * ball.centre_W;
  const double distance = centre_S.norm();
  const double radius = ball.radius + rounding_of(distance + ball.radius);
  if (!(distance > radius)) return extent;
  extent.nearest = distance - radius;
  const double level = centre_S.head<2>().norm();
  const double elevation = std::atan2(centre_S.z(), level);
  const double half = std::asin(radius / distance);
  extent.least_elevation = elevation - half;
  extent.most_elevation = elevation + half;
  if (!(level > radius)) return extent;
  const double bearing = std::atan2(centre_S.y(), centre_S.x());
  const double half_width = std::asin(radius / level);
  extent.first_bearing = bearing - half_width;
  extent.last_bearing = bearing + half_width;
  return extent;
}

// Returns the extent of the corners of a box, and so of everything between them.
Extent extent_of(const std::array<Vector3d, 8>& corners_S) {
  Extent extent;
  Vector2d centre = Vector2d::Zero();
  for (const Vector3d& corner : corners_S) centre += 0.125 * corner.head<2>();
  const double rounding = rounding_of(corners_S[0].norm() + (corners_S[7] - corners_S[0]).norm());
  const double level = centre.norm();
  if (!(level > rounding)) return extent;
  const Vector2d ahead = centre / level;
  double least = infinity;  // along `ahead`: least distance from the axis
  double farthest = 0.0;    // greatest distance from the axis
  double right = 0.0, left = 0.0;
  double lowest = infinity, highest = -infinity;
  for (const Vector3d& corner : corners_S) {
    const Vector2d at = corner.head<2>();
    const double along = ahead.dot(at);
    const double bearing = std::atan2(cross(ahead, at), along);
    right = std::min(right, bearing);
    left = std::max(left, bearing);
    least = std::min(least, along);
    farthest = std::max(farthest, at.norm());
    lowest = std::min(lowest, corner.z());
    highest = std::max(highest, corner.z());
  }
  least -= rounding;
  farthest += rounding;
  lowest -= rounding;
  highest += rounding;
  if (least > 0.0) {
    extent.nearest = least;
    extent.least_elevation = std::atan2(lowest, lowest < 0.0 ? least : farthest);
    extent.most_elevation = std::atan2(highest, highest > 0.0 ? least : farthest);
  }
  // Otherwise the corners span at least half a turn: they surround the axis.
  if (left - right < pi - 1e-3 && least > 0.0) {
    const double bearing = std::atan2(centre.y(), centre.x());
    const double widened = std::asin(std::min(1.0, rounding / least));
    extent.first_bearing = bearing + right - widened;
    extent.last_bearing = bearing + left + widened;
  }
  return extent;
}

std::array<Vector3d, 8> corners_of(const Vector3d& lower, const Vector3d& upper, const Pose& X_SB) {
  std::array<Vector3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = X_SB * Vector3d((i & 1) != 0 ? upper.x() : lower.x(), (i & 2) != 0 ? upper.y() : lower.y(),
                                 (i & 4) != 0 ? upper.z() : lower.z());
  return corners;
}

// A ray of elevation e hits the surface at some bearing if it descends there: |n_xy| cos e - n_z sin e > 0.
Extent extent_of(const description::Plane& plane, const Pose& X_WC, const Pose& X_WS) {
  Extent extent;
  const Vector3d normal_W = X_WC.orientation * plane.normal;
  const double height = normal_W.dot(X_WS.position - X_WC.position);
  const double rounding = rounding_of((X_WS.position - X_WC.position).norm());
  if (!(height > rounding)) return extent;
  const Vector3d normal_S = X_WS.orientation.conjugate() * normal_W;
  extent.nearest = height - rounding;
  extent.most_elevation = std::atan2(normal_S.head<2>().norm(), normal_S.z());
  return extent;
}

Extent extent_of(const Scene& scene, std::uint32_t index, const Pose& X_WS, const Pose& X_SW) {
  const Solid& solid = scene.solid(index);
  if (const auto* plane = std::get_if<description::Plane>(&solid.shape())) return extent_of(*plane, solid.X_WC, X_WS);
  if (const auto* box = std::get_if<description::Box>(&solid.shape()))
    return extent_of(corners_of(-0.5 * box->size, 0.5 * box->size, X_SW * solid.X_WC));
  if (std::holds_alternative<description::Mesh>(solid.shape()))
    return extent_of(corners_of(scene.bounds(index).lower, scene.bounds(index).upper, X_SW));
  return extent_of(scene.ball(index), X_SW);
}

}  // namespace

Panorama::Panorama(std::size_t columns, std::vector<double> elevations) : elevations_(std::move(elevations)) {
  if (columns < 4) throw std::invalid_argument("a panorama needs at least 4 columns");
  if (elevations_.empty()) throw std::invalid_argument("a panorama needs at least one row");
  ascending_ = elevations_.front() <= elevations_.back();
  const bool in_order = ascending_ ? std::is_sorted(elevations_.begin(), elevations_.end())
                                   : std::is_sorted(elevations_.rbegin(), elevations_.rend());
  if (!in_order || !(std::abs(elevations_.front()) <= 0.5 * pi) || !(std::abs(elevations_.back()) <= 0.5 * pi))
    throw std::invalid_argument("the elevations of a panorama must be sorted and within +-90 degrees");
  for (std::size_t column = 0; column < columns; ++column) {
    const double bearing = 2.0 * pi * static_cast<double>(column) / static_cast<double>(columns);
    bearings_S_.emplace_back(std::cos(bearing), std::sin(bearing));
  }
  for (const double elevation : elevations_)
    for (const Vector2d& bearing : bearings_S_)
      directions_S_.emplace_back(std::cos(elevation) * bearing.x(), std::cos(elevation) * bearing.y(),
                                 std::sin(elevation));
}

std::pair<std::size_t, std::size_t> Panorama::rows_between(double least, double most) const {
  const auto index = [](auto begin, auto at) { return static_cast<std::size_t>(at - begin); };
  const auto first = [&](auto begin, auto end) {
    return index(begin, std::lower_bound(begin, end, least - angle_slack));
  };
  const auto last = [&](auto begin, auto end) {
    return index(begin, std::upper_bound(begin, end, most + angle_slack));
  };
  if (ascending_) return {first(elevations_.begin(), elevations_.end()), last(elevations_.begin(), elevations_.end())};
  return {rows() - last(elevations_.rbegin(), elevations_.rend()),
          rows() - first(elevations_.rbegin(), elevations_.rend())};
}

std::optional<Panorama::Window> Panorama::window_of(const Scene& scene, std::uint32_t solid, const View& view) const {
  const Extent extent = extent_of(scene, solid, view.X_WS, view.X_SW);
  if (extent.nearest > view.range) return std::nullopt;
  Window window;
  window.nearest = extent.nearest;
  window.solid = solid;
  std::tie(window.first_row, window.last_row) = rows_between(extent.least_elevation, extent.most_elevation);
  if (window.first_row >= window.last_row) return std::nullopt;
  const auto count = static_cast<std::int64_t>(columns());
  const double a_radian = static_cast<double>(count) / (2.0 * pi);
  // The first column at or after the first bearing, and the last one at or before the last bearing.
  const std::int64_t first = -integer_floor(-(extent.first_bearing - angle_slack) * a_radian);
  const std::int64_t last = integer_floor((extent.last_bearing + angle_slack) * a_radian);
  if (last < first) return std::nullopt;
  window.first_column = static_cast<std::size_t>((first % count + count) % count);
  window.columns = static_cast<std::size_t>(std::min(last - first + 1, count));
  return window;
}

void Panorama::cast(const Outlines& outlines, const Pose& X_WS, double range, BodyId ignored_body,
                    std::span<std::optional<RayHit>> pixels) const {
  const Scene& scene = outlines.scene();
  const View view{X_WS, X_WS.inverse(), range};
  std::vector<Window> windows;
  outlines.for_each_near(X_WS.position, range, [&](const Outlines::Item& item) {
    if (item.body == ignored_body) return;
    if (const auto window = window_of(scene, item.solid, view)) windows.push_back(*window);
  });
  std::sort(windows.begin(), windows.end(), [](const Window& a, const Window& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.solid < b.solid;
  });

  std::fill(pixels.begin(), pixels.end(), std::nullopt);
  std::vector<Vector3d> directions_W;
  directions_W.reserve(directions_S_.size());
  for (const Vector3d& direction_S : directions_S_) directions_W.push_back(X_WS.orientation * direction_S);
  for (const Window& window : windows) {
    const Scene::Ball ball = scene.ball(window.solid);
    for (std::size_t row = window.first_row; row < window.last_row; ++row) {
      std::size_t column = window.first_column;
      for (std::size_t i = 0; i < window.columns; ++i) {
        const std::size_t at = pixel(column, row);
        if (++column == columns()) column = 0;
        std::optional<RayHit>& best = pixels[at];
        const double reach = best ? best->distance : range;
        if (window.nearest > reach || ball.is_missed(X_WS.position, directions_W[at], reach)) continue;
        scene.improve(best, window.solid, X_WS.position, directions_W[at], range);
      }
    }
  }
}

}  // namespace cohort::geometry
