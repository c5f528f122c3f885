// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "server/actuation/actuator_kinds.hpp"
#include "server/actuation/wheel_speeds.hpp"

namespace cohort::actuation {
namespace {

/// Velocity along x [m/s] and about z [rad/s].
class TrackedDrive final : public ActuatorOf<description::TrackedDrive> {
 public:
  using ActuatorOf::ActuatorOf;
  std::vector<Channel> channels() const override { return twist_channels(device_); }
  void apply(std::span<const double> values) override {
    const double difference = 0.5 * device_.track_separation * values[1] / device_.steering_efficiency;
    const std::size_t left = device_.left_links.size();
    run(0, left, values[0] - difference);
    run(left, left + device_.right_links.size(), values[0] + difference);
  }

 private:
  void run(std::size_t begin, std::size_t end, double velocity) {
    for (std::size_t belt = begin; belt < end; ++belt)
      mount_.world.set_device_target(mount_.body, mount_.device, belt,
                                     std::clamp(velocity, -device_.max_velocity, device_.max_velocity));
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::TrackedDrive& drive, const Mount& mount) {
  return std::make_unique<TrackedDrive>(drive, mount);
}

}  // namespace cohort::actuation
