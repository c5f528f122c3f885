#include "server/sensing/accelerometer.hpp"

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

std::vector<Channel> Accelerometer::channels() const {
  return {{sensor_.name + "/0/acceleration", "m/s^2", 3, -infinity, infinity, 0.0}};
}

void Accelerometer::sense(std::uint64_t, std::span<double> values) const {
  write(proper_acceleration_of(sensor_, mount_), values);
}

}  // namespace cohort::sensing
