#include "server/sensing/force_torque_sensor.hpp"

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

std::vector<Channel> ForceTorqueSensor::channels() const {
  return {{sensor_.name + "/0/force", "N", 3, -infinity, infinity, 0.0},
          {sensor_.name + "/0/torque", "N m", 3, -infinity, infinity, 0.0}};
}

Eigen::Quaterniond ForceTorqueSensor::axes_W() const {
  using Frame = description::ForceTorqueSensor::Frame;
  if (sensor_.axes == Frame::parent)
    return joint_.parent == description::Joint::world ? Eigen::Quaterniond::Identity()
                                                      : mount_.world.link_pose(mount_.body, joint_.parent).orientation;
  const Eigen::Quaterniond child_W = mount_.world.link_pose(mount_.body, joint_.child).orientation;
  if (sensor_.axes == Frame::child) return child_W;
  return child_W * joint_.X_LJ.orientation * sensor_.X_JS.orientation;
}

void ForceTorqueSensor::sense(std::uint64_t, std::span<double> values) const {
  const physics::Wrench on_child = mount_.world.joint_wrench(mount_.body, sensor_.joint);
  const Eigen::Quaterniond W_axes = axes_W().conjugate();
  const double sign = sensor_.is_on_parent ? -1.0 : 1.0;
  write(Eigen::Vector3d(W_axes * (sign * on_child.force_W)), values);
  write(Eigen::Vector3d(W_axes * (sign * on_child.torque_W)), values.subspan(3));
}

}  // namespace cohort::sensing
