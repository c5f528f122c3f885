// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Temperature and humidity of the world, plus those of nearby sources (description::ClimateSource).
class ClimateSensor final : public SensorOf<description::ClimateSensor> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/temperature", "K", 1, 0.0, infinity, 0.0},
            {device_.name + "/0/humidity", "1", 1, 0.0, 1.0, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Eigen::Vector3d p_W = mount_.world.link_pose(mount_.body, LinkId{device_.link}) * device_.p_LS;
    double temperature = mount_.description.climate.temperature;
    double humidity = mount_.description.climate.humidity;
    for (const emission::ClimateSource& source : mount_.emitters.climate_sources()) {
      if (!source.is_on || !mount_.emitters.is_in_world(source.mount)) continue;
      const double widths = (source.p_W - p_W).norm() / source.source.spread;
      const double share = std::exp(-0.5 * widths * widths);
      temperature += share * source.source.temperature;
      humidity += share * source.source.humidity;
    }
    values[0] = std::max(temperature, 0.0);
    values[1] = std::clamp(humidity, 0.0, 1.0);
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::ClimateSensor& sensor, const Mount& mount) {
  return std::make_unique<ClimateSensor>(sensor, mount);
}

}  // namespace cohort::sensing
