#include "server/sensing/inclinometer.hpp"

#include <cmath>
#include <numbers>

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

std::vector<Channel> Inclinometer::channels() const {
  constexpr double pi = std::numbers::pi;
  return {{sensor_.name + "/0/roll", "rad", 1, -pi, pi, 0.0},
          {sensor_.name + "/0/pitch", "rad", 1, -0.5 * pi, 0.5 * pi, 0.0}};
}

void Inclinometer::sense(std::uint64_t, std::span<double> values) const {
  const Eigen::Vector3d up_S = pose_of(sensor_, mount_).orientation.conjugate() * -mount_.description.gravity;
  values[0] = values[1] = 0.0;
  if (up_S.isZero(0.0)) return;
  values[0] = std::atan2(up_S.y(), up_S.z());
  values[1] = std::atan2(-up_S.x(), std::sqrt(up_S.y() * up_S.y() + up_S.z() * up_S.z()));
}

}  // namespace cohort::sensing
