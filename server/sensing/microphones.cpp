#include "server/sensing/microphones.hpp"

#include <algorithm>

#include "server/sensing/saturation.hpp"

namespace cohort::sensing {

std::vector<Channel> Microphones::channels() const {
  const auto bands = static_cast<std::uint32_t>(microphones_.bands.size());
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < microphones_.places_L.size(); ++i)
    channels.push_back({microphones_.name + "/" + std::to_string(i) + "/intensity", "1", bands, 0.0, 1.0, 0.0});
  return channels;
}

void Microphones::sense(std::uint64_t, std::span<double> values) const {
  constexpr double least_distance = 1e-3;  // [m]: at no distance a source would be infinitely loud
  const Pose X_WL = mount_.world.link_pose(mount_.body, microphones_.link);
  const std::size_t bands = microphones_.bands.size();
  std::ranges::fill(values, 0.0);
  for (const std::uint32_t index : mount_.emitters.sounding_tones()) {
    const emission::Tone& tone = mount_.emitters.tone(index);
    if (tone.mount.body == mount_.body) continue;
    const Eigen::Vector3d p_L = X_WL.orientation.conjugate() * (tone.p_W - X_WL.position);
    for (std::size_t band = 0; band < bands; ++band) {
      const double frequency = tone.sound.frequency;
      if (frequency < microphones_.bands[band].x() || frequency > microphones_.bands[band].y()) continue;
      for (std::size_t i = 0; i < microphones_.places_L.size(); ++i) {
        const double distance = std::max((p_L - microphones_.places_L[i]).norm(), least_distance);
        if (distance <= tone.sound.range) values[i * bands + band] += tone.sound.intensity / (distance * distance);
      }
    }
  }
  for (double& value : values) value = saturated(microphones_.gain * value);
}

}  // namespace cohort::sensing
