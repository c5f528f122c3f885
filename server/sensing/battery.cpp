#include "server/sensing/battery.hpp"

#include <algorithm>
#include <limits>

namespace cohort::sensing {

Battery::Battery(const description::Battery& battery, const description::Model& model, Mount mount)
    : battery_(battery),
      mount_(std::move(mount)),
      step_(std::chrono::duration<double>(mount_.description.step).count()),
      energy_(battery.capacity * battery.charge) {
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    if (const auto motor = description::motor_limits(model.devices[device]))
      motor_joints_.push_back(motor->joint);
    else if (std::holds_alternative<description::TreelDrive>(model.devices[device]))
      drives_.push_back(device);
  }
}

std::vector<Channel> Battery::channels() const {
  return {{battery_.name + "/0/charge", "1", 1, 0.0, 1.0, 0.0},
          {battery_.name + "/0/power", "W", 1, 0.0, std::numeric_limits<double>::infinity(), 0.0}};
}

double Battery::mechanical_power() const {
  double power = 0.0;
  for (const std::size_t joint : motor_joints_)
    power +=
        std::max(0.0, mount_.world.joint_effort(mount_.body, joint) * mount_.world.joint_velocity(mount_.body, joint));
  for (const std::size_t drive : drives_) {
    for (const physics::Side side : {physics::Side::left, physics::Side::right}) {
      const physics::TrackState track = mount_.world.track(mount_.body, drive, side);
      power += std::max(0.0, track.traction * track.velocity);
    }
  }
  return power;
}

void Battery::remember(std::uint64_t tick, bool) {
  if (tick == noted_tick_) return;  // nothing has moved since, or at all yet
  noted_tick_ = tick;
  power_ = energy_ > 0.0 ? battery_.idle_power + mechanical_power() / battery_.motor_efficiency : 0.0;
  energy_ = std::max(0.0, energy_ - power_ * step_);
}

void Battery::sense(std::uint64_t, std::span<double> values) const {
  values[0] = energy_ / battery_.capacity;
  values[1] = power_;
}

}  // namespace cohort::sensing
