// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "server/core/state_visitors.hpp"
#include "server/physics/world/driven_power.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Charge and power of a robot's battery (description::Battery). Over each step it supplies its idle power, plus the
/// mechanical power of all actuators of the robot / efficiency; a braking motor returns nothing.
class Battery final : public SensorOf<description::Battery> {
 public:
  Battery(const description::Battery& battery, const Mount& mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

  void remember(std::uint64_t tick, bool was_delivered) override;
  bool disables_robot() const override { return energy_ <= 0.0; }
  void hash(StateHash& hash) const override { hash.add(energy_); }
  void save(SnapshotWriter& writer) const override { visit_memory(*this, StateSaver{writer}); }
  void restore(SnapshotReader& reader) override { visit_memory(*this, StateRestorer{reader}); }

 private:
  template <class Self, class Visit>
  static void visit_memory(Self& self, Visit&& visit) {
    visit(self.energy_);
    visit(self.power_);
    visit(self.noted_tick_);
  }

  double step_ = 0.0;    // [s]
  double energy_ = 0.0;  // remaining energy [J]
  double power_ = 0.0;   // over the last step [W]
  std::uint64_t noted_tick_ = 0;
};

Battery::Battery(const description::Battery& battery, const Mount& mount)
    : SensorOf(battery, mount),
      step_(std::chrono::duration<double>(mount.description.step).count()),
      energy_(battery.capacity * battery.charge) {}

std::vector<Channel> Battery::channels() const {
  return {{device_.name + "/0/charge", "1", 1, 0.0, 1.0, 0.0}, {device_.name + "/0/power", "W", 1, 0.0, infinity, 0.0}};
}

void Battery::remember(std::uint64_t tick, bool) {
  if (tick == noted_tick_) return;  // nothing has moved since, or at all yet
  noted_tick_ = tick;
  power_ = energy_ > 0.0
               ? device_.idle_power + driven_power(mount_.world, mount_.body, mount_.model()) / device_.motor_efficiency
               : 0.0;
  energy_ = std::max(0.0, energy_ - power_ * step_);
}

void Battery::sense(std::uint64_t, std::span<double> values) const {
  values[0] = energy_ / device_.capacity;
  values[1] = power_;
}

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Battery& battery, const Mount& mount) {
  return std::make_unique<Battery>(battery, mount);
}

}  // namespace cohort::sensing
