#include "server/sensing/light_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/sensing/saturation.hpp"

namespace cohort::sensing {
namespace {

using description::Light;

// A lamp is no nearer than this [m]: at no distance it would be infinitely bright.
constexpr double least_distance = 1e-3;
// From where a directional light comes [m].
constexpr double far_away = std::numeric_limits<double>::infinity();

double brightness(const emission::Lamp& lamp) { return lamp.light.intensity * lamp.light.color.sum() / 3.0; }

// 1 of all but spots.
double within_cone(const emission::Lamp& lamp, const Eigen::Vector3d& direction_W) {
  if (lamp.light.kind != Light::Kind::spot) return 1.0;
  const double along = -direction_W.dot(lamp.direction_W);
  const double inner = std::cos(lamp.light.inner_angle);
  const double outer = std::cos(lamp.light.outer_angle);
  if (along >= inner) return 1.0;
  if (along <= outer) return 0.0;
  return std::exp(lamp.light.falloff * std::log((along - outer) / (inner - outer)));
}

}  // namespace

double arriving_light(const emission::Lamp& lamp, const Eigen::Vector3d& direction_W, double distance) {
  const Light& light = lamp.light;
  if (light.kind == Light::Kind::directional) return brightness(lamp);
  if (distance > light.range) return 0.0;
  const double d = std::max(distance, least_distance);
  const double arriving = brightness(lamp) / (light.constant + d * (light.linear + d * light.quadratic));
  return arriving * within_cone(lamp, direction_W);
}

LightSensors::LightSensors(const description::LightSensors& sensors, Mount mount)
    : sensors_(sensors),
      mount_(std::move(mount)),
      ring_(mount_.lamp_view.add_ring(mount_.body, sensors.link, sensors.X_LS.position)) {
  if (sensors.samples) table_.emplace(sensors.samples);
  for (std::size_t i = 0; i < sensors.count; ++i) {
    const double bearing = sensors.first_bearing + static_cast<double>(i) * sensors.spacing;
    directions_S_.emplace_back(std::cos(bearing), std::sin(bearing), 0.0);
  }
}

std::vector<Channel> LightSensors::channels() const {
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < sensors_.count; ++i)
    channels.push_back({sensors_.name + "/" + std::to_string(i) + "/reading", "1", 1, 0.0, 1.0, 0.0});
  return channels;
}

void LightSensors::sense(std::uint64_t, std::span<double> values) const {
  const Pose X_WS = mount_.world.link_pose(mount_.body, sensors_.link) * sensors_.X_LS;
  std::ranges::fill(values, 0.0);
  const std::span<const std::uint32_t> lamps = mount_.emitters.lit_lamps();
  for (std::uint32_t place = 0; place < lamps.size(); ++place) {
    const emission::Lamp& lamp = mount_.emitters.lamp(lamps[place]);
    if (lamp.mount.body == mount_.body) continue;
    const bool is_far_away = lamp.light.kind == Light::Kind::directional;
    const Eigen::Vector3d offset_W =
        is_far_away ? Eigen::Vector3d(-lamp.direction_W) : Eigen::Vector3d(lamp.p_W - X_WS.position);
    const double distance = offset_W.norm();
    if (!(distance > 0.0)) continue;
    const Eigen::Vector3d direction_W = offset_W / distance;
    const double arriving = arriving_light(lamp, direction_W, distance);
    if (!(arriving > 0.0)) continue;
    if (is_far_away ? !mount_.world.scene().is_free(X_WS.position, direction_W, far_away, mount_.body)
                    : !mount_.lamp_view.is_in_sight(place, ring_))
      continue;
    const Eigen::Vector3d direction_S = X_WS.orientation.conjugate() * direction_W;
    if (table_ && !is_far_away) {
      const double bearing = std::atan2(direction_S.y(), direction_S.x());
      table_->add(distance, bearing, brightness(lamp) * within_cone(lamp, direction_W), values);
      continue;
    }
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] += arriving * std::max(0.0, direction_S.dot(directions_S_[i]));
  }
  for (double& value : values) value = saturated(sensors_.gain * value);
}

}  // namespace cohort::sensing
