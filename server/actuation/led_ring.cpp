#include "server/actuation/led_ring.hpp"

namespace cohort::actuation {

std::vector<Channel> LedRing::channels() const {
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < leds_.count; ++i)
    channels.push_back({leds_.name + "/" + std::to_string(i) + "/color", "1", 3, 0.0, 1.0, 0.0});
  return channels;
}

void LedRing::apply(std::span<const double> values) {
  for (std::uint32_t i = 0; i < leds_.count; ++i) {
    const Eigen::Vector3d color(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    mount_.emitters.set_marker(first_.marker + i, color);
    if (leds_.intensity > 0.0) mount_.emitters.set_lamp(first_.lamp + i, color);
  }
}

}  // namespace cohort::actuation
