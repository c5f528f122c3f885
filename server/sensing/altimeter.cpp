#include "server/sensing/altimeter.hpp"

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

Altimeter::Altimeter(const description::Altimeter& altimeter, Mount mount)
    : altimeter_(altimeter), mount_(std::move(mount)), first_height_(pose_of(altimeter, mount_).position.z()) {}

std::vector<Channel> Altimeter::channels() const {
  return {{altimeter_.name + "/0/vertical_position", "m", 1, -infinity, infinity, 0.0},
          {altimeter_.name + "/0/vertical_velocity", "m/s", 1, -infinity, infinity, 0.0}};
}

void Altimeter::sense(std::uint64_t, std::span<double> values) const {
  values[0] = pose_of(altimeter_, mount_).position.z() - first_height_;
  values[1] = velocity_of(altimeter_, mount_).z();
}

}  // namespace cohort::sensing
