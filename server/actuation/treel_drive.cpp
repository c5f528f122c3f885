#include "server/actuation/treel_drive.hpp"

namespace cohort::actuation {

std::vector<Channel> TreelDrive::channels() const {
  std::vector<Channel> channels;
  for (const char* side : {"/left", "/right"})
    channels.push_back({drive_.name + side + "/velocity", "m/s", 1, -drive_.max_velocity, drive_.max_velocity, 0.0});
  return channels;
}

void TreelDrive::apply(std::span<const double> values) {
  mount_.world.set_track_velocity_target(mount_.body, device_, physics::Side::left, values[0]);
  mount_.world.set_track_velocity_target(mount_.body, device_, physics::Side::right, values[1]);
}

}  // namespace cohort::actuation
