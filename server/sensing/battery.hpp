#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Charge and power of a robot's battery (description::Battery). Over each step it gives its idle power and, for every
/// motor and track that moves its load, force times velocity / efficiency; a motor that brakes gives nothing back.
class Battery final : public Sensor {
 public:
  Battery(const description::Battery& battery, const description::Model& model, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

  bool has_memory() const override { return true; }
  void remember(std::uint64_t tick, bool was_delivered) override;
  bool is_exhausted() const override { return energy_ <= 0.0; }
  void hash(StateHash& hash) const override { hash.add(energy_); }
  void save(SnapshotWriter& writer) const override {
    writer.add(energy_);
    writer.add(power_);
    writer.add(noted_tick_);
  }
  void restore(SnapshotReader& reader) override {
    reader.read(energy_);
    reader.read(power_);
    reader.read(noted_tick_);
  }

 private:
  double mechanical_power() const;

  description::Battery battery_;
  Mount mount_;
  std::vector<std::size_t> motor_joints_;
  std::vector<std::size_t> drives_;  // devices of the model
  double step_ = 0.0;                // [s]
  double energy_ = 0.0;              // that is left [J]
  double power_ = 0.0;               // over the last step [W]
  std::uint64_t noted_tick_ = 0;
};

}  // namespace cohort::sensing
