#include "server/sensing/imu.hpp"

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

Imu::Imu(const description::Imu& imu, Mount mount) : imu_(imu), mount_(std::move(mount)) {
  const Eigen::Vector3d& rpy = imu.reference_rpy;
  const Eigen::Quaterniond turned = Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
  R_RW_ = turned.conjugate();
  if (!imu.is_relative_to_world) R_RW_ = R_RW_ * pose_of(imu, mount_).orientation.conjugate();
}

std::vector<Channel> Imu::channels() const {
  std::vector<Channel> channels;
  if (imu_.has_orientation) channels.push_back({imu_.name + "/0/orientation", "1", 4, -1.0, 1.0, 0.0, false});
  channels.push_back({imu_.name + "/0/angular_velocity", "rad/s", 3, -infinity, infinity, 0.0});
  channels.push_back({imu_.name + "/0/linear_acceleration", "m/s^2", 3, -infinity, infinity, 0.0});
  return channels;
}

void Imu::sense(std::uint64_t, std::span<double> values) const {
  const Eigen::Quaterniond R_WS = pose_of(imu_, mount_).orientation;
  if (imu_.has_orientation) {
    write(Eigen::Quaterniond(R_RW_ * R_WS), values);
    values = values.subspan(4);
  }
  write(Eigen::Vector3d(R_WS.conjugate() * mount_.world.link_twist(mount_.body, imu_.link).angular_W), values);
  write(proper_acceleration_of(imu_, mount_), values.subspan(3));
}

}  // namespace cohort::sensing
