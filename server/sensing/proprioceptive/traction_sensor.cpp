// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Force of a joint's child on its parent over the last step, in the xy plane of the parent (thesis, section 1.1).
class TractionSensor final : public SensorOf<description::TractionSensor> {
 public:
  TractionSensor(const description::TractionSensor& sensor, const Mount& mount)
      : SensorOf(sensor, mount), parent_(mount.joint(sensor.joint).parent) {}
  std::vector<Channel> channels() const override {
    const std::string prefix = device_.name + "/0/";
    return {{prefix + "direction", "rad", 1, -std::numbers::pi, std::numbers::pi, 0.0},
            {prefix + "intensity", "N", 1, 0.0, infinity, 0.0},
            {prefix + "force", "N", 2, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Eigen::Vector3d on_parent_W =
        mount_.world.joint_wrench_on_parent(mount_.body, JointId{device_.joint}).force_W;
    Eigen::Vector3d force = on_parent_W;
    if (parent_ != description::Joint::world)
      force = mount_.world.link_pose(mount_.body, LinkId{parent_}).orientation.conjugate() * on_parent_W;
    values[1] = std::sqrt(force.x() * force.x() + force.y() * force.y());
    values[0] = values[1] > 0.0 ? std::atan2(force.y(), force.x()) : 0.0;
    values[2] = force.x();
    values[3] = force.y();
  }
  bool needs_record() const override { return true; }

 private:
  std::size_t parent_;  // link
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::TractionSensor& sensor, const Mount& mount) {
  return std::make_unique<TractionSensor>(sensor, mount);
}

}  // namespace cohort::sensing
