// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Orientation and angular velocity of S, and its proper acceleration: that of its origin at the end of the last
/// step, minus gravity; at rest it is g upwards. The orientation is the rotation of S in its frame of reference (REP
/// 145; SDF 1.9, <orientation_reference_frame>).
class Imu final : public SensorOf<description::Imu> {
 public:
  Imu(const description::Imu& imu, const Mount& mount) : SensorOf(imu, mount) {
    const Eigen::Vector3d& rpy = imu.reference_rpy;
    const Eigen::Quaterniond turned = Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
    R_RW_ = turned.conjugate();
    if (!imu.is_relative_to_world) R_RW_ = R_RW_ * pose_of(imu, mount).orientation.conjugate();
  }
  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    if (device_.has_orientation) channels.push_back({device_.name + "/0/orientation", "1", 4, -1.0, 1.0, 0.0, false});
    channels.push_back({device_.name + "/0/angular_velocity", "rad/s", 3, -infinity, infinity, 0.0});
    channels.push_back({device_.name + "/0/linear_acceleration", "m/s^2", 3, -infinity, infinity, 0.0});
    return channels;
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Eigen::Quaterniond R_WS = pose_of(device_, mount_).orientation;
    if (device_.has_orientation) {
      write(Eigen::Quaterniond(R_RW_ * R_WS), values);
      values = values.subspan(4);
    }
    write(Eigen::Vector3d(R_WS.conjugate() * mount_.world.link_twist(mount_.body, LinkId{device_.link}).angular_W),
          values);
    write(proper_acceleration_of(device_, mount_), values.subspan(3));
  }
  bool needs_record() const override { return true; }

 private:
  Eigen::Quaterniond R_RW_;  // R: the frame of reference
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Imu& imu, const Mount& mount) {
  return std::make_unique<Imu>(imu, mount);
}

}  // namespace cohort::sensing
