// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// State of a gripper: its opening, whether it holds an object, the force, and its light barrier.
class GripperSensor final : public SensorOf<description::Gripper> {
 public:
  GripperSensor(const description::Gripper& gripper, const Mount& mount)
      : SensorOf(gripper, mount), number_(mount.grippers.of_device(mount.body, mount.device)) {}
  std::vector<Channel> channels() const override {
    const std::string prefix = device_.name + "/0/";
    return {{prefix + "opening", "1", 1, 0.0, 1.0, 0.0},
            {prefix + "gripping", "1", 1, 0.0, 1.0, 0.0, false},
            {prefix + "force", "N", 1, 0.0, infinity, 0.0},
            {prefix + "grippable", "1", 1, 0.0, 1.0, 0.0, false}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    values[0] = mount_.grippers.opening(number_);
    values[1] = mount_.grippers.is_gripping(number_) ? 1.0 : 0.0;
    values[2] = mount_.grippers.force(number_);
    values[3] = mount_.grippers.is_something_between(number_) ? 1.0 : 0.0;
  }

 private:
  std::uint32_t number_;
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Gripper& gripper, const Mount& mount) {
  return std::make_unique<GripperSensor>(gripper, mount);
}

}  // namespace cohort::sensing
