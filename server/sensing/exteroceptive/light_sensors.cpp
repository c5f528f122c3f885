// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "server/sensing/exteroceptive/lamp_view.hpp"
#include "server/sensing/placed.hpp"
#include "server/sensing/readings/sample_table.hpp"
#include "server/sensing/readings/saturation.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

using description::Light;

// Minimum distance of a lamp [m], as its light would be infinite at distance 0.
constexpr double least_distance = 1e-3;
// Distance of a directional light [m].
constexpr double far_away = infinity;

double brightness(const emission::Lamp& lamp) { return lamp.light.intensity * lamp.light.color.sum() / 3.0; }

// Returns 1 for all lamps except spots.
double within_cone(const emission::Lamp& lamp, const Eigen::Vector3d& direction_W) {
  if (lamp.light.kind != Light::Kind::spot) return 1.0;
  const double along = -direction_W.dot(lamp.direction_W);
  const double inner = std::cos(lamp.light.inner_angle);
  const double outer = std::cos(lamp.light.outer_angle);
  if (along >= inner) return 1.0;
  if (along <= outer) return 0.0;
  return std::exp(lamp.light.falloff * std::log((along - outer) / (inner - outer)));
}

// Returns the light of a visible lamp at a point [1]; `direction_W`: unit vector from the point to the lamp.
double arriving_light(const emission::Lamp& lamp, const Eigen::Vector3d& direction_W, double distance) {
  const Light& light = lamp.light;
  if (light.kind == Light::Kind::directional) return brightness(lamp);
  if (distance > light.range) return 0.0;
  const double d = std::max(distance, least_distance);
  const double arriving = brightness(lamp) / (light.constant + d * (light.linear + d * light.quadratic));
  return arriving * within_cone(lamp, direction_W);
}

/// Light from all active, visible lamps. One ray between the lamp and the middle of the ring decides the visibility
/// (LampView; thesis, section 3.2.3). A sensor receives the light at its place times the cosine of the angle between
/// its axis and the lamp (Lambert's law), and nothing from behind. A colour counts by the mean of its three parts
/// (description::Light). The reading is the sum over the lamps times the gain, saturated. With samples, distance and
/// cosine are replaced by the table's readings for the lamp's distance and bearing, times the light of the lamp at 1 m.
class LightSensors final : public SensorOf<description::LightSensors> {
 public:
  LightSensors(const description::LightSensors& sensors, const Mount& mount)
      : SensorOf(sensors, mount),
        lamp_view_(mount.views.get<LampView>(mount.world, mount.emitters)),
        ring_(lamp_view_.add_ring(mount.body, LinkId{sensors.link}, sensors.X_LS.position)) {
    if (sensors.samples) table_.emplace(sensors.samples);
    for (std::size_t i = 0; i < sensors.count; ++i) {
      const double bearing = sensors.first_bearing + static_cast<double>(i) * sensors.spacing;
      directions_S_.emplace_back(std::cos(bearing), std::sin(bearing), 0.0);
    }
  }
  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < device_.count; ++i)
      channels.push_back({device_.name + "/" + std::to_string(i) + "/reading", "1", 1, 0.0, 1.0, 0.0});
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Pose X_WS = pose_of(device_, mount_);
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
                      : !lamp_view_.is_in_sight(place, ring_))
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
    for (double& value : values) value = saturated(device_.gain * value);
  }
  bool has_shared_view() const override { return true; }
  void ask_shared_view() override { lamp_view_.ask(ring_); }

 private:
  LampView& lamp_view_;
  std::uint32_t ring_;  // index in the lamp view
  std::vector<Eigen::Vector3d> directions_S_;
  std::optional<SampleTable> table_;
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::LightSensors& sensors, const Mount& mount) {
  return std::make_unique<LightSensors>(sensors, mount);
}

}  // namespace cohort::sensing
