#include "server/sensing/traction_sensor.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace cohort::sensing {

std::vector<Channel> TractionSensor::channels() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string prefix = sensor_.name + "/0/";
  return {{prefix + "direction", "rad", 1, -std::numbers::pi, std::numbers::pi, 0.0},
          {prefix + "intensity", "N", 1, 0.0, infinity, 0.0},
          {prefix + "force", "N", 2, -infinity, infinity, 0.0}};
}

void TractionSensor::sense(std::uint64_t, std::span<double> values) const {
  const Eigen::Vector3d on_parent_W = -mount_.world.joint_wrench(mount_.body, sensor_.joint).force_W;
  Eigen::Vector3d force = on_parent_W;
  if (joint_.parent != description::Joint::world)
    force = mount_.world.link_pose(mount_.body, joint_.parent).orientation.conjugate() * on_parent_W;
  values[1] = std::sqrt(force.x() * force.x() + force.y() * force.y());
  values[0] = values[1] > 0.0 ? std::atan2(force.y(), force.x()) : 0.0;
  values[2] = force.x();
  values[3] = force.y();
}

}  // namespace cohort::sensing
