#include "server/sensing/proximity_ring.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/core/integer_floor.hpp"
#include "server/geometry/outlines.hpp"

namespace cohort::sensing {
namespace {

using description::ProximityTechnique;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t shadow_directions = 360;

double heading_of(const Pose& X_WS) {
  const Vector3d x_W = X_WS.orientation * Vector3d::UnitX();
  return std::atan2(x_W.y(), x_W.x());
}

// From a point, seen from above; zero if the point is inside.
Vector2d to_nearest_point(const geometry::Outline& outline, const Vector2d& p_W) {
  const Vector2d offset = outline.centre_W - p_W;
  if (outline.is_round()) {
    const double distance = offset.norm();
    return distance > outline.radius ? Vector2d(offset * ((distance - outline.radius) / distance)) : Vector2d(0.0, 0.0);
  }
  const Vector2d& axis = outline.axis_W;
  const Vector2d side(-axis.y(), axis.x());
  const auto gap = [](double along, double half) { return along - std::clamp(along, -half, half); };
  return gap(axis.dot(offset), outline.half.x()) * axis + gap(side.dot(offset), outline.half.y()) * side;
}

}  // namespace

ProximityRing::ProximityRing(const description::ProximityRing& ring, Mount mount)
    : ring_(ring), mount_(std::move(mount)), random_(mount_.seed, mount_.robot, ring.name + "/cone") {
  for (std::size_t i = 0; i < ring.count; ++i)
    directions_S_.emplace_back(std::cos(bearing_of(i)), std::sin(bearing_of(i)), 0.0);
  const double half = 0.5 * ring.cone;
  shadow_width_ = std::atan2(ring.range * std::sin(half), ring.ring_radius + ring.range * std::cos(half));
  if (ring.technique == ProximityTechnique::shadow) shadows_.emplace(shadow_directions);
  if (ring.technique == ProximityTechnique::samples) table_.emplace(ring.samples);
}

double ProximityRing::bearing_of(std::size_t sensor) const {
  return ring_.first_bearing + static_cast<double>(sensor) * ring_.spacing;
}

std::vector<Channel> ProximityRing::channels() const {
  double least = 0.0, greatest = 1.0;
  if (table_) {
    greatest = std::max(0.0, *std::ranges::max_element(ring_.samples->readings));
    least = std::min(0.0, *std::ranges::min_element(ring_.samples->readings));
  }
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < ring_.count; ++i)
    channels.push_back({ring_.name + "/" + std::to_string(i) + "/reading", table_ ? ring_.samples->units[i] : "1", 1,
                        least, greatest, 0.0});
  return channels;
}

void ProximityRing::sense(std::uint64_t tick, std::span<double> values) const {
  const Pose X_WS = mount_.world.link_pose(mount_.body, ring_.link) * ring_.X_LS;
  switch (ring_.technique) {
    case ProximityTechnique::ray: return cast_axes(X_WS, values);
    case ProximityTechnique::random_ray:
    case ProximityTechnique::five_rays: return cast_in_cones(tick, X_WS, values);
    case ProximityTechnique::shadow: return cast_shadows(X_WS, values);
    case ProximityTechnique::samples: return look_up(X_WS, values);
  }
}

double ProximityRing::reading(const geometry::RayFan& fan, const Pose& X_WS, std::size_t sensor,
                              const Vector3d& direction_S) const {
  const Vector3d origin_W = X_WS.position + ring_.ring_radius * (X_WS.orientation * directions_S_[sensor]);
  const auto hit = fan.cast(origin_W, X_WS.orientation * direction_S, ring_.range);
  return hit ? 1.0 - hit->distance / ring_.range : 0.0;
}

void ProximityRing::cast_axes(const Pose& X_WS, std::span<double> values) const {
  const geometry::Bounds disc = geometry::bounds_of_disc(X_WS, ring_.ring_radius + ring_.range);
  const geometry::RayFan fan(mount_.world.scene(), X_WS.position, disc, mount_.body);
  for (std::size_t i = 0; i < ring_.count; ++i) values[i] = reading(fan, X_WS, i, directions_S_[i]);
}

// A sensor's axis, turned towards its left and upwards. [rad]
Vector3d ProximityRing::turned(std::size_t sensor, double aside, double up) const {
  const Vector3d& axis = directions_S_[sensor];
  const Vector3d left(-axis.y(), axis.x(), 0.0);
  const double angle = std::sqrt(aside * aside + up * up);
  if (angle == 0.0) return axis;
  const Vector3d across = (aside * left + up * Vector3d::UnitZ()) / angle;
  return std::cos(angle) * axis + std::sin(angle) * across;
}

void ProximityRing::cast_in_cones(std::uint64_t tick, const Pose& X_WS, std::span<double> values) const {
  constexpr double rounding = 1e-9;
  const double reach = ring_.ring_radius + ring_.range + rounding;
  const geometry::RayFan fan(mount_.world.scene(), X_WS.position,
                             geometry::Bounds{X_WS.position, X_WS.position}.grown_by(reach), mount_.body);
  const double half = 0.5 * ring_.cone;
  const double beside = std::sqrt(5.0 / 8.0) * half;
  for (std::size_t i = 0; i < ring_.count; ++i) {
    if (ring_.technique == ProximityTechnique::random_ray) {
      const auto draw = static_cast<std::uint32_t>(2 * i);
      const double angle = std::acos(1.0 - random_.uniform(tick, draw) * (1.0 - std::cos(half)));
      const double around = 2.0 * std::numbers::pi * random_.uniform(tick, draw + 1);
      values[i] = reading(fan, X_WS, i, turned(i, angle * std::cos(around), angle * std::sin(around)));
      continue;
    }
    double sum = reading(fan, X_WS, i, directions_S_[i]);
    for (const double angle : {-beside, beside})
      sum += reading(fan, X_WS, i, turned(i, angle, 0.0)) + reading(fan, X_WS, i, turned(i, 0.0, angle));
    values[i] = sum / 5.0;
  }
}

void ProximityRing::cast_shadows(const Pose& X_WS, std::span<double> values) const {
  std::vector<double> distances(shadow_directions);
  shadows_->cast(mount_.world.scene(), X_WS.position, heading_of(X_WS), ring_.ring_radius + ring_.range, mount_.body,
                 distances);
  constexpr auto count = static_cast<std::int64_t>(shadow_directions);
  constexpr double a_radian = static_cast<double>(shadow_directions) / (2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < ring_.count; ++i) {
    const std::int64_t nearest = integer_floor(bearing_of(i) * a_radian + 0.5);
    const std::int64_t first = std::min(nearest, -integer_floor(-(bearing_of(i) - shadow_width_) * a_radian));
    const std::int64_t last = std::max(nearest, integer_floor((bearing_of(i) + shadow_width_) * a_radian));
    double sum = 0.0;
    for (std::int64_t k = first; k <= last; ++k) {
      const double distance = distances[static_cast<std::size_t>((k % count + count) % count)] - ring_.ring_radius;
      sum += std::clamp(1.0 - distance / ring_.range, 0.0, 1.0);
    }
    values[i] = sum / static_cast<double>(last - first + 1);
  }
}

void ProximityRing::look_up(const Pose& X_WS, std::span<double> values) const {
  std::ranges::fill(values, 0.0);
  const geometry::Scene& scene = mount_.world.scene();
  const double heading = heading_of(X_WS);
  geometry::Bounds disc = geometry::Bounds{X_WS.position, X_WS.position}.grown_by(table_->range());
  disc.lower.z() = disc.upper.z() = X_WS.position.z();
  scene.for_each_overlap(disc, [&](std::uint32_t index) {
    const geometry::Solid& solid = scene.solid(index);
    if (solid.body == mount_.body || geometry::is_ground(solid.shape)) return;
    const auto outline = geometry::outline_of(solid, scene.bounds(index));
    if (!outline) return;
    const Vector2d nearest = to_nearest_point(*outline, X_WS.position.head<2>());
    const Vector2d towards = nearest.isZero(0.0) ? Vector2d(outline->centre_W - X_WS.position.head<2>()) : nearest;
    table_->keep_greatest(nearest.norm(), std::atan2(towards.y(), towards.x()) - heading, values);
  });
}

}  // namespace cohort::sensing
