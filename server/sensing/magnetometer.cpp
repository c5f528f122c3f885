#include "server/sensing/magnetometer.hpp"

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

std::vector<Channel> Magnetometer::channels() const {
  return {{sensor_.name + "/0/magnetic_field", "T", 3, -infinity, infinity, 0.0}};
}

void Magnetometer::sense(std::uint64_t, std::span<double> values) const {
  write(Eigen::Vector3d(pose_of(sensor_, mount_).orientation.conjugate() * mount_.description.magnetic_field), values);
}

}  // namespace cohort::sensing
