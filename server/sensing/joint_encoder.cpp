#include "server/sensing/joint_encoder.hpp"

#include <limits>

namespace cohort::sensing {

std::vector<Channel> JointEncoder::channels() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string unit = joint_.type == description::JointType::prismatic ? "m" : "rad";
  return {{encoder_.name + "/0/position", unit, 1, joint_.axis.lower, joint_.axis.upper, 0.0},
          {encoder_.name + "/0/velocity", unit + "/s", 1, -infinity, infinity, 0.0}};
}

void JointEncoder::sense(std::uint64_t, std::span<double> values) const {
  values[0] = mount_.world.joint_position(mount_.body, encoder_.joint);
  values[1] = mount_.world.joint_velocity(mount_.body, encoder_.joint);
}

}  // namespace cohort::sensing
