// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "server/actuation/actuator_kinds.hpp"
#include "server/actuation/wheel_speeds.hpp"

namespace cohort::actuation {
namespace {

/// Velocity of the middle of the rear axle along x [m/s] and about z [rad/s]. Each steered wheel is perpendicular to
/// the line from it to the centre of the turn, which is on the line of that axle.
class AckermannDrive final : public ActuatorOf<description::AckermannDrive> {
 public:
  AckermannDrive(const description::AckermannDrive& drive, const Mount& mount)
      : ActuatorOf(drive, mount), greatest_curvature_(std::tan(drive.steering_limit) / drive.wheel_base) {}

  std::vector<Channel> channels() const override { return twist_channels(device_); }
  void apply(std::span<const double> values) override {
    const double linear = values[0];
    const double curvature = curvature_of(linear, values[1]);
    set_wheel_speeds(device_, mount_, linear, linear * curvature);
    const auto steer = [&](std::size_t joint, double side) {
      const double ahead = device_.wheel_base * curvature;
      const double aside = 1.0 - side * 0.5 * device_.kingpin_width * curvature;
      mount_.world.set_joint_target(mount_.body, JointId{joint},
                                    physics::JointTarget::position(std::atan2(ahead, aside)));
    };
    steer(device_.left_steering_joint, 1.0);
    steer(device_.right_steering_joint, -1.0);
  }

 private:
  // Returns the curvature [1/m]. At rest it is the tightest one to that side.
  double curvature_of(double linear, double angular) const {
    if (angular == 0.0) return 0.0;
    if (linear == 0.0) return std::copysign(greatest_curvature_, angular);
    return std::clamp(angular / linear, -greatest_curvature_, greatest_curvature_);
  }

  double greatest_curvature_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::AckermannDrive& drive, const Mount& mount) {
  return std::make_unique<AckermannDrive>(drive, mount);
}

}  // namespace cohort::actuation
