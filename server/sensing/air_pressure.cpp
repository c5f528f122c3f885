#include "server/sensing/air_pressure.hpp"

#include <cmath>

#include "server/sensing/placed.hpp"

namespace cohort::sensing {

double standard_pressure(double height) {
  constexpr double at_sea = 101325.0;       // p0 [Pa]
  constexpr double temperature = 288.15;    // T0 [K]
  constexpr double lapse_rate = 0.0065;     // L [K/m]
  constexpr double gravity = 9.80665;       // g [m/s^2]
  constexpr double molar_mass = 0.0289644;  // M [kg/mol]
  constexpr double gas_constant = 8.31432;  // R, as the standard has it [J/(mol K)]
  const double base = 1.0 - lapse_rate * height / temperature;
  if (base <= 0.0) return 0.0;
  return at_sea * std::exp(gravity * molar_mass / (gas_constant * lapse_rate) * std::log(base));
}

std::vector<Channel> AirPressureSensor::channels() const {
  return {{sensor_.name + "/0/pressure", "Pa", 1, 0.0, infinity, 0.0}};
}

void AirPressureSensor::sense(std::uint64_t, std::span<double> values) const {
  values[0] = standard_pressure(sensor_.reference_altitude + pose_of(sensor_, mount_).position.z());
}

}  // namespace cohort::sensing
