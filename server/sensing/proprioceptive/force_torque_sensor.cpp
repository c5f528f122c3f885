// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Wrench of a joint over the last step: force, and torque about the origin of the joint. It acts on the parent by the
/// child or vice versa, in the axes of the child, the parent or S (SDF 1.9, <force_torque>). It has turned with the
/// link in whose axes it is given. Zero for a planar body.
class ForceTorqueSensor final : public SensorOf<description::ForceTorqueSensor> {
 public:
  ForceTorqueSensor(const description::ForceTorqueSensor& sensor, const Mount& mount)
      : SensorOf(sensor, mount), joint_(mount.joint(sensor.joint)) {}
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/force", "N", 3, -infinity, infinity, 0.0},
            {device_.name + "/0/torque", "N m", 3, -infinity, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const bool is_of_parent = device_.axes == description::ForceTorqueSensor::Frame::parent;
    const JointId joint{device_.joint};
    const physics::Wrench wrench = is_of_parent ? mount_.world.joint_wrench_on_parent(mount_.body, joint)
                                                : mount_.world.joint_wrench(mount_.body, joint);
    const Eigen::Quaterniond W_axes = axes_W().conjugate();
    const double sign = device_.is_on_parent == is_of_parent ? 1.0 : -1.0;
    write(Eigen::Vector3d(W_axes * (sign * wrench.force_W)), values);
    write(Eigen::Vector3d(W_axes * (sign * wrench.torque_W)), values.subspan(3));
  }
  bool needs_record() const override { return true; }

 private:
  Eigen::Quaterniond axes_W() const {
    using Frame = description::ForceTorqueSensor::Frame;
    if (device_.axes == Frame::parent)
      return joint_.parent == description::Joint::world
                 ? Eigen::Quaterniond::Identity()
                 : mount_.world.link_pose(mount_.body, LinkId{joint_.parent}).orientation;
    const Eigen::Quaterniond child_W = mount_.world.link_pose(mount_.body, LinkId{joint_.child}).orientation;
    if (device_.axes == Frame::child) return child_W;
    return child_W * joint_.X_LJ.orientation * device_.X_JS.orientation;
  }

  description::Joint joint_;
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::ForceTorqueSensor& sensor, const Mount& mount) {
  return std::make_unique<ForceTorqueSensor>(sensor, mount);
}

}  // namespace cohort::sensing
