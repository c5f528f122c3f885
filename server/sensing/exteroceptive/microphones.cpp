// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "server/sensing/readings/sample_table.hpp"
#include "server/sensing/readings/saturation.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Sounds within frequency bands, from all directions, without reflection or occlusion (thesis, section 3.2.4). The
/// sound at a distance d [m] is the intensity of the source / d^2. The reading is the sum over the sources times the
/// gain, saturated. With samples, the distance is replaced by the table's readings for the source's distance from the
/// link's origin and its bearing from the link's x axis, times its intensity. A robot does not receive its own sounds.
class Microphones final : public SensorOf<description::Microphones> {
 public:
  Microphones(const description::Microphones& microphones, const Mount& mount) : SensorOf(microphones, mount) {
    if (microphones.samples) table_.emplace(microphones.samples);
  }
  std::vector<Channel> channels() const override {
    const auto bands = static_cast<std::uint32_t>(device_.bands.size());
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < device_.places_L.size(); ++i)
      channels.push_back({device_.name + "/" + std::to_string(i) + "/intensity", "1", bands, 0.0, 1.0, 0.0});
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    constexpr double least_squared = 1e-6;  // [m^2]: the intensity would be infinite at distance 0
    const Pose X_WL = mount_.world.link_pose(mount_.body, LinkId{device_.link});
    std::vector<Eigen::Vector3d> places_W;
    places_W.reserve(device_.places_L.size());
    for (const Eigen::Vector3d& p_L : device_.places_L) places_W.push_back(X_WL * p_L);
    std::vector<double> sampled(places_W.size());
    const std::size_t bands = device_.bands.size();
    std::ranges::fill(values, 0.0);
    for (const std::uint32_t index : mount_.emitters.sounding_tones()) {
      const emission::Tone& tone = mount_.emitters.tone(index);
      if (tone.mount.body == mount_.body) continue;
      const double frequency = tone.sound.frequency;
      if (table_) {
        const Eigen::Vector3d p_L = X_WL.orientation.conjugate() * (tone.p_W - X_WL.position);
        std::ranges::fill(sampled, 0.0);
        if (p_L.norm() <= tone.sound.range)
          table_->add(p_L.norm(), std::atan2(p_L.y(), p_L.x()), tone.sound.intensity, sampled);
      }
      const double range_squared = tone.sound.range * tone.sound.range;
      for (std::size_t band = 0; band < bands; ++band) {
        if (frequency < device_.bands[band].x() || frequency > device_.bands[band].y()) continue;
        for (std::size_t i = 0; i < places_W.size(); ++i) {
          if (table_) {
            values[i * bands + band] += sampled[i];
            continue;
          }
          const double squared = std::max((tone.p_W - places_W[i]).squaredNorm(), least_squared);
          if (squared <= range_squared) values[i * bands + band] += tone.sound.intensity / squared;
        }
      }
    }
    for (double& value : values) value = saturated(device_.gain * value);
  }

 private:
  std::optional<SampleTable> table_;
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Microphones& microphones, const Mount& mount) {
  return std::make_unique<Microphones>(microphones, mount);
}

}  // namespace cohort::sensing
