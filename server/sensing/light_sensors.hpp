#pragma once

#include <optional>

#include "server/sensing/sample_table.hpp"
#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Light from all lamps that are on and in sight, as one ray between the lamp and the middle of the ring decides
/// (LampView; thesis, section 3.2.3). Of what arrives there (description::Light; a colour counts by the mean of its
/// three parts) a sensor gets the share of the cosine of the angle between its axis and the lamp (Lambert's law),
/// nothing from behind. The reading is the sum over the lamps times the gain, saturated. With samples, the table's
/// readings for the lamp's distance and bearing, times what a lamp as bright gives at 1 m, take the place of distance
/// and cosine.
class LightSensors final : public Sensor {
 public:
  LightSensors(const description::LightSensors& sensors, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::LightSensors sensors_;
  Mount mount_;
  std::uint32_t ring_;  // number in the lamp view
  std::vector<Eigen::Vector3d> directions_S_;
  std::optional<SampleTable> table_;
};

/// What arrives at a place of a lamp in sight [1]; `direction_W`: from there to the lamp, unit.
double arriving_light(const emission::Lamp& lamp, const Eigen::Vector3d& direction_W, double distance);

}  // namespace cohort::sensing
