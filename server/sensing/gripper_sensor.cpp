#include "server/sensing/gripper_sensor.hpp"

#include <limits>

namespace cohort::sensing {

std::vector<Channel> GripperSensor::channels() const {
  const std::string prefix = gripper_.name + "/0/";
  return {{prefix + "opening", "1", 1, 0.0, 1.0, 0.0},
          {prefix + "gripping", "1", 1, 0.0, 1.0, 0.0, false},
          {prefix + "force", "N", 1, 0.0, std::numeric_limits<double>::infinity(), 0.0},
          {prefix + "grippable", "1", 1, 0.0, 1.0, 0.0, false}};
}

void GripperSensor::sense(std::uint64_t, std::span<double> values) const {
  values[0] = mount_.grippers.opening(number_);
  values[1] = mount_.grippers.is_gripping(number_) ? 1.0 : 0.0;
  values[2] = mount_.grippers.force(number_);
  values[3] = mount_.grippers.is_something_between(number_) ? 1.0 : 0.0;
}

}  // namespace cohort::sensing
