#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Messages of the robots around (description::RangeAndBearing) and where they came from. A message is heard if its
/// sender's range reaches here and a ray to the sender meets nothing but the two robots themselves. What is heard
/// between two deliveries adds up, the newest tick first; of one tick the nearest first, and of two at the same
/// distance the one with the lower beacon. What exceeds the capacity is lost.
class MessageReceiver final : public Sensor {
 public:
  MessageReceiver(const description::RangeAndBearing& device, Mount mount)
      : device_(device), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

  bool has_memory() const override { return true; }
  void remember(std::uint64_t tick, bool was_delivered) override;
  void hash(StateHash& hash) const override;
  void save(SnapshotWriter& writer) const override;
  void restore(SnapshotReader& reader) override;

 private:
  std::size_t size_of_one() const { return 3 + device_.message_size; }

  description::RangeAndBearing device_;
  Mount mount_;
  std::vector<double> heard_;   // range, bearing, elevation and message of each, in the order of the report
  std::vector<double> before_;  // of these, those of ticks before `noted_tick_`
  std::uint64_t noted_tick_ = ~std::uint64_t{0};
};

}  // namespace cohort::sensing
