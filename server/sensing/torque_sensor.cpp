#include "server/sensing/torque_sensor.hpp"

#include <limits>

namespace cohort::sensing {

std::vector<Channel> TorqueSensor::channels() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool slides = joint_.type == description::JointType::prismatic;
  return {{sensor_.name + (slides ? "/0/force" : "/0/torque"), slides ? "N" : "N m", 1, -infinity, infinity, 0.0}};
}

}  // namespace cohort::sensing
