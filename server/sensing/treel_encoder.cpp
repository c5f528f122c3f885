#include "server/sensing/treel_encoder.hpp"

#include <limits>

namespace cohort::sensing {

std::vector<Channel> TreelEncoder::channels() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Channel> channels;
  for (const char* side : {"/left", "/right"}) {
    channels.push_back({encoder_.name + side + "/position", "m", 1, -infinity, infinity, 0.0});
    channels.push_back({encoder_.name + side + "/velocity", "m/s", 1, -infinity, infinity, 0.0});
  }
  return channels;
}

void TreelEncoder::sense(std::uint64_t, std::span<double> values) const {
  std::size_t i = 0;
  for (const physics::Side side : {physics::Side::left, physics::Side::right}) {
    const physics::TrackState track = mount_.world.track(mount_.body, encoder_.drive, side);
    values[i++] = track.position;
    values[i++] = track.velocity;
  }
}

}  // namespace cohort::sensing
