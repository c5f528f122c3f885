// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/shadow_ring.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "server/core/infinity.hpp"
#include "server/core/integer_floor.hpp"
#include "server/core/plane_vectors.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double level = 1e-9;  // planes that are tilted by less are ground

void keep(double& nearest, double distance, double range) {
  if (distance <= range) nearest = std::min(nearest, distance);
}

}  // namespace

ShadowRing::ShadowRing(std::size_t directions) {
  if (directions < 4) throw std::invalid_argument("a shadow ring needs at least 4 directions");
  for (std::size_t k = 0; k < directions; ++k) {
    const double bearing = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(directions);
    directions_R_.emplace_back(std::cos(bearing), std::sin(bearing));
  }
}

void ShadowRing::cast(const Scene& scene, const Vector3d& p_WR, double heading, double range, BodyId ignored_body,
                      std::span<double> distances) const {
  std::fill(distances.begin(), distances.end(), infinity);
  const Vector2d x_W(std::cos(heading), std::sin(heading));
  const auto turned = [&](const Vector2d& v_W) { return Vector2d(x_W.dot(v_W), cross(x_W, v_W)); };
  Bounds disc = Bounds{p_WR, p_WR}.grown_by(range);
  disc.lower.z() = disc.upper.z() = p_WR.z();
  scene.for_each_overlap(disc, [&](std::uint32_t index) {
    const Solid& solid = scene.solid(index);
    if (solid.body == ignored_body || std::holds_alternative<description::Heightmap>(solid.shape())) return;
    if (const auto* plane = std::get_if<description::Plane>(&solid.shape())) {
      const Vector3d normal_W = solid.X_WC.orientation * plane->normal;
      if (normal_W.head<2>().norm() > level)
        shade_by_line(turned(normal_W.head<2>()), normal_W.dot(p_WR - solid.X_WC.position), range, distances);
      return;
    }
    const std::optional<Outline> outline = outline_of(solid, scene.bounds(index));
    if (!outline) return;
    const Shadow shadow{turned(outline->centre_W - p_WR.head<2>()), turned(outline->axis_W), outline->half,
                        outline->radius};
    if (outline->is_round())
      shade_by_circle(shadow, range, distances);
    else
      shade_by_rectangle(shadow, range, distances);
  });
}

template <class Visit>
void ShadowRing::for_each_between(double first_bearing, double last_bearing, Visit&& visit) const {
  const auto count = static_cast<std::int64_t>(size());
  const double a_radian = static_cast<double>(count) / (2.0 * std::numbers::pi);
  const std::int64_t first = integer_floor(first_bearing * a_radian) - 1;
  const std::int64_t last = std::min(integer_floor(last_bearing * a_radian) + 2, first + count - 1);
  std::int64_t k = first % count;
  if (k < 0) k += count;
  for (std::int64_t i = first; i <= last; ++i) {
    visit(static_cast<std::size_t>(k));
    if (++k == count) k = 0;
  }
}

void ShadowRing::shade_by_circle(const Shadow& circle, double range, std::span<double> distances) const {
  const double radius_squared = circle.radius * circle.radius;
  const double squared = circle.centre.squaredNorm();
  if (squared <= radius_squared) {
    std::fill(distances.begin(), distances.end(), 0.0);
    return;
  }
  if (std::sqrt(squared) - circle.radius > range) return;
  const double bearing = std::atan2(circle.centre.y(), circle.centre.x());
  const double half = std::asin(circle.radius / std::sqrt(squared));
  for_each_between(bearing - half, bearing + half, [&](std::size_t k) {
    const double along = directions_R_[k].dot(circle.centre);
    const double beside = cross(directions_R_[k], circle.centre);
    const double discriminant = radius_squared - beside * beside;
    if (discriminant >= 0.0 && along > 0.0) keep(distances[k], along - std::sqrt(discriminant), range);
  });
}

void ShadowRing::shade_by_rectangle(const Shadow& rectangle, double range, std::span<double> distances) const {
  const Vector2d& axis = rectangle.axis;
  const Vector2d& half = rectangle.half;
  const Vector2d source(-axis.dot(rectangle.centre), -cross(axis, rectangle.centre));
  if ((source.cwiseAbs().array() <= half.array()).all()) {
    std::fill(distances.begin(), distances.end(), 0.0);
    return;
  }
  if ((source.cwiseAbs() - half).cwiseMax(0.0).norm() > range) return;
  const Vector2d edge = half.x() * axis;
  const Vector2d side = half.y() * left_of(axis);
  // Bearings of its extent relative to that of the centre: all corners are within half a turn.
  double least = 0.0;
  double most = 0.0;
  for (const Vector2d& corner : {Vector2d(rectangle.centre - edge - side), Vector2d(rectangle.centre + edge - side),
                                 Vector2d(rectangle.centre + edge + side), Vector2d(rectangle.centre - edge + side)}) {
    const double bearing = std::atan2(cross(rectangle.centre, corner), rectangle.centre.dot(corner));
    least = std::min(least, bearing);
    most = std::max(most, bearing);
  }
  const double bearing = std::atan2(rectangle.centre.y(), rectangle.centre.x());
  for_each_between(bearing + least, bearing + most, [&](std::size_t k) {
    const Vector2d v(axis.dot(directions_R_[k]), cross(axis, directions_R_[k]));
    double first = 0.0;
    double last = infinity;
    for (int i = 0; i < 2; ++i) {
      if (v[i] == 0.0) {
        if (std::abs(source[i]) > half[i]) return;
        continue;
      }
      const double reach = v[i] > 0.0 ? half[i] : -half[i];
      first = std::max(first, (-reach - source[i]) / v[i]);
      last = std::min(last, (reach - source[i]) / v[i]);
    }
    if (first <= last) keep(distances[k], first, range);
  });
}

void ShadowRing::shade_by_line(const Vector2d& normal, double height, double range, std::span<double> distances) const {
  if (height <= 0.0) {
    std::fill(distances.begin(), distances.end(), 0.0);
    return;
  }
  for (std::size_t k = 0; k < size(); ++k) {
    const double descent = -directions_R_[k].dot(normal);
    if (descent > 0.0) keep(distances[k], height / descent, range);
  }
}

}  // namespace cohort::geometry
