#pragma once

#include <optional>

#include "server/sensing/sample_table.hpp"
#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Sounds within bands of frequency, from everywhere: nothing reflects or hides a sound (thesis, section 3.2.4). What
/// arrives at a distance d [m] is the intensity of the source / d^2. The reading is the sum over the sources times the
/// gain, saturated. With samples, the table's readings for the source's distance from the link's origin and its bearing
/// from the link's x axis, times its intensity, take the place of the distance. A robot does not hear itself.
class Microphones final : public Sensor {
 public:
  Microphones(const description::Microphones& microphones, Mount mount)
      : microphones_(microphones), mount_(std::move(mount)) {
    if (microphones.samples) table_.emplace(microphones.samples);
  }
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::Microphones microphones_;
  Mount mount_;
  std::optional<SampleTable> table_;
};

}  // namespace cohort::sensing
