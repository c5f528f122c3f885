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
    run(device_.left_links, values[0] - difference);
    run(device_.right_links, values[0] + difference);
  }

 private:
  void run(const std::vector<std::size_t>& links, double velocity) {
    for (const std::size_t link : links)
      mount_.world.set_belt_velocity_target(mount_.body, LinkId{link},
                                            std::clamp(velocity, -device_.max_velocity, device_.max_velocity));
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::TrackedDrive& drive, const Mount& mount) {
  return std::make_unique<TrackedDrive>(drive, mount);
}

}  // namespace cohort::actuation
