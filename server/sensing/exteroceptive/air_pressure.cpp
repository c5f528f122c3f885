// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

// Returns the pressure [Pa] at `height` above the sea [m]; 0 where the formula has no air.
double standard_pressure(double height) {
  constexpr double at_sea = 101325.0;       // p0 [Pa]
  constexpr double temperature = 288.15;    // T0 [K]
  constexpr double lapse_rate = 0.0065;     // L [K/m]
  constexpr double gravity = 9.80665;       // g [m/s^2]
  constexpr double molar_mass = 0.0289644;  // M [kg/mol]
  constexpr double gas_constant = 8.31432;  // R of the standard [J/(mol K)]
  const double base = 1.0 - lapse_rate * height / temperature;
  if (base <= 0.0) return 0.0;
  return at_sea * std::exp(gravity * molar_mass / (gas_constant * lapse_rate) * std::log(base));
}

/// Air pressure at the height of S above the sea, p = p0 (1 - L h / T0)^(g M / (R L)). It is that of the International
/// Standard Atmosphere (ICAO Doc 7488, its lowest layer, continued above and below).
class AirPressureSensor final : public SensorOf<description::AirPressureSensor> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/pressure", "Pa", 1, 0.0, infinity, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    values[0] = standard_pressure(device_.reference_altitude + pose_of(device_, mount_).position.z());
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::AirPressureSensor& sensor, const Mount& mount) {
  return std::make_unique<AirPressureSensor>(sensor, mount);
}

}  // namespace cohort::sensing
