// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "server/core/integer_floor.hpp"
#include "server/core/plane_vectors.hpp"
#include "server/core/random.hpp"
#include "server/geometry/scene/ray_fan.hpp"
#include "server/geometry/visibility/outlines.hpp"
#include "server/geometry/visibility/shadow_ring.hpp"
#include "server/sensing/placed.hpp"
#include "server/sensing/readings/sample_table.hpp"
#include "server/sensing/sensor_kinds.hpp"

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

// Returns the vector from a point, seen from above; zero if the point is inside.
Vector2d to_nearest_point(const geometry::Outline& outline, const Vector2d& p_W) {
  const Vector2d offset = outline.centre_W - p_W;
  if (outline.is_round()) {
    const double distance = offset.norm();
    return distance > outline.radius ? Vector2d(offset * ((distance - outline.radius) / distance)) : Vector2d(0.0, 0.0);
  }
  const Vector2d& axis = outline.axis_W;
  const Vector2d side = left_of(axis);
  const auto gap = [](double along, double half) { return along - std::clamp(along, -half, half); };
  return gap(axis.dot(offset), outline.half.x()) * axis + gap(side.dot(offset), outline.half.y()) * side;
}

/// Infrared proximity. The real sensor covers a cone of 40 degrees and 20 cm (thesis, section 3.2.1). A ray of length
/// `range` that hits something at distance d has the value 1 - d / range, and 0 without a hit. The reading is the mean
/// value over the cone, which the techniques of the thesis approximate.
/// `ray`: the ray along the sensor's axis alone.
/// `random_ray`: another ray at each tick, uniformly distributed in the cone (in solid angle). The mean over many ticks
/// is correct, and even small objects are detected.
/// `five_rays`: the mean of the ray along the axis and four at sqrt(5/8) of half the cone from it, to both sides, up
/// and down. At that angle the mean of the five equals that over a small cone for every function of up to third order
/// (equal second moments: 4/5 t^2 = R^2 / 2).
/// `shadow`: the mean over the directions of a ShadowRing of 360 that end in the mouth of the sensor's cone. They start
/// in the middle of the ring, and count from `ring_radius` on. So they are within
/// atan2(range sin c, ring_radius + range cos c) of the axis, for half a cone c.
/// `samples`: the readings of a table for each solid that intersects the plane of the ring and is not ground. They
/// depend on the distance of its nearest point from the middle of the ring, and on that point's bearing, seen from
/// above and without occlusion. The greatest reading counts.
class ProximityRing final : public SensorOf<description::ProximityRing> {
 public:
  ProximityRing(const description::ProximityRing& ring, const Mount& mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  double bearing_of(std::size_t sensor) const;
  Eigen::Vector3d turned(std::size_t sensor, double aside, double up) const;
  double reading(const geometry::RayFan& fan, const Pose& X_WS, std::size_t sensor,
                 const Eigen::Vector3d& direction_S) const;
  void cast_axes(const Pose& X_WS, std::span<double> values) const;
  void cast_in_cones(std::uint64_t tick, const Pose& X_WS, std::span<double> values) const;
  void cast_shadows(const Pose& X_WS, std::span<double> values) const;
  void look_up(const Pose& X_WS, std::span<double> values) const;

  std::vector<Eigen::Vector3d> directions_S_;
  RandomStream random_;
  std::optional<geometry::ShadowRing> shadows_;
  double shadow_width_ = 0.0;  // half the angle of a sensor's directions at the middle of the ring
  std::optional<SampleTable> table_;
};

ProximityRing::ProximityRing(const description::ProximityRing& ring, const Mount& mount)
    : SensorOf(ring, mount), random_(mount.seed, mount.robot_name(), ring.name + "/cone") {
  for (std::size_t i = 0; i < ring.count; ++i)
    directions_S_.emplace_back(std::cos(bearing_of(i)), std::sin(bearing_of(i)), 0.0);
  const double half = 0.5 * ring.cone;
  shadow_width_ = std::atan2(ring.range * std::sin(half), ring.ring_radius + ring.range * std::cos(half));
  if (ring.technique == ProximityTechnique::shadow) shadows_.emplace(shadow_directions);
  if (ring.technique == ProximityTechnique::samples) table_.emplace(ring.samples);
}

double ProximityRing::bearing_of(std::size_t sensor) const {
  return device_.first_bearing + static_cast<double>(sensor) * device_.spacing;
}

std::vector<Channel> ProximityRing::channels() const {
  double least = 0.0, greatest = 1.0;
  if (table_) {
    greatest = std::max(0.0, *std::ranges::max_element(device_.samples->readings));
    least = std::min(0.0, *std::ranges::min_element(device_.samples->readings));
  }
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < device_.count; ++i)
    channels.push_back({device_.name + "/" + std::to_string(i) + "/reading", table_ ? device_.samples->units[i] : "1",
                        1, least, greatest, 0.0});
  return channels;
}

void ProximityRing::sense(std::uint64_t tick, std::span<double> values) const {
  const Pose X_WS = pose_of(device_, mount_);
  switch (device_.technique) {
    case ProximityTechnique::ray: return cast_axes(X_WS, values);
    case ProximityTechnique::random_ray:
    case ProximityTechnique::five_rays: return cast_in_cones(tick, X_WS, values);
    case ProximityTechnique::shadow: return cast_shadows(X_WS, values);
    case ProximityTechnique::samples: return look_up(X_WS, values);
  }
}

double ProximityRing::reading(const geometry::RayFan& fan, const Pose& X_WS, std::size_t sensor,
                              const Vector3d& direction_S) const {
  const Vector3d origin_W = X_WS.position + device_.ring_radius * (X_WS.orientation * directions_S_[sensor]);
  const auto hit = fan.cast(origin_W, X_WS.orientation * direction_S, device_.range);
  return hit ? 1.0 - hit->distance / device_.range : 0.0;
}

void ProximityRing::cast_axes(const Pose& X_WS, std::span<double> values) const {
  const geometry::Bounds disc = geometry::bounds_of_disc(X_WS, device_.ring_radius + device_.range);
  const geometry::RayFan fan(mount_.world.scene(), X_WS.position, disc, mount_.body);
  for (std::size_t i = 0; i < device_.count; ++i) values[i] = reading(fan, X_WS, i, directions_S_[i]);
}

// Returns a sensor's axis, rotated to its left and upwards [rad].
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
  const double reach = device_.ring_radius + device_.range + rounding;
  const geometry::RayFan fan(mount_.world.scene(), X_WS.position,
                             geometry::Bounds{X_WS.position, X_WS.position}.grown_by(reach), mount_.body);
  const double half = 0.5 * device_.cone;
  const double beside = std::sqrt(5.0 / 8.0) * half;
  for (std::size_t i = 0; i < device_.count; ++i) {
    if (device_.technique == ProximityTechnique::random_ray) {
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
  shadows_->cast(mount_.world.scene(), X_WS.position, heading_of(X_WS), device_.ring_radius + device_.range,
                 mount_.body, distances);
  constexpr auto count = static_cast<std::int64_t>(shadow_directions);
  constexpr double a_radian = static_cast<double>(shadow_directions) / (2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < device_.count; ++i) {
    const std::int64_t nearest = integer_floor(bearing_of(i) * a_radian + 0.5);
    const std::int64_t first = std::min(nearest, -integer_floor(-(bearing_of(i) - shadow_width_) * a_radian));
    const std::int64_t last = std::max(nearest, integer_floor((bearing_of(i) + shadow_width_) * a_radian));
    double sum = 0.0;
    for (std::int64_t k = first; k <= last; ++k) {
      const double distance = distances[static_cast<std::size_t>((k % count + count) % count)] - device_.ring_radius;
      sum += std::clamp(1.0 - distance / device_.range, 0.0, 1.0);
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
    if (solid.body == mount_.body || geometry::is_ground(solid.shape())) return;
    const auto outline = geometry::outline_of(solid, scene.bounds(index));
    if (!outline) return;
    const Vector2d nearest = to_nearest_point(*outline, X_WS.position.head<2>());
    const Vector2d towards = nearest.isZero(0.0) ? Vector2d(outline->centre_W - X_WS.position.head<2>()) : nearest;
    table_->keep_greatest(nearest.norm(), std::atan2(towards.y(), towards.x()) - heading, values);
  });
}

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::ProximityRing& ring, const Mount& mount) {
  return std::make_unique<ProximityRing>(ring, mount);
}

}  // namespace cohort::sensing
