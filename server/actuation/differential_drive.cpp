// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"
#include "server/actuation/wheel_speeds.hpp"

namespace cohort::actuation {
namespace {

/// Velocity along x [m/s] and about z [rad/s].
class DifferentialDrive final : public ActuatorOf<description::DifferentialDrive> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override { return twist_channels(device_); }
  void apply(std::span<const double> values) override { set_wheel_speeds(device_, mount_, values[0], values[1]); }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::DifferentialDrive& drive, const Mount& mount) {
  return std::make_unique<DifferentialDrive>(drive, mount);
}

}  // namespace cohort::actuation
