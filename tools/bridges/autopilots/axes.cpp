// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/autopilots/axes.hpp"

#include <cmath>
#include <numbers>

namespace cohort::autopilots {
namespace {

// The standard atmosphere.
constexpr double at_sea = 101325.0;     // [Pa]
constexpr double temperature = 288.15;  // [K]
constexpr double lapse_rate = 0.0065;   // [K/m]
constexpr double exponent = 5.25588;    // g M / (R L)

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

}  // namespace

Quaternion frd_to_ned(std::span<const double> flu_to_enu) {
  const double x = flu_to_enu[0], y = flu_to_enu[1], z = flu_to_enu[2], w = flu_to_enu[3];
  const double s = (w + z < 0.0 ? -1.0 : 1.0) * std::sqrt(0.5);
  return {s * (w + z), s * (x + y), s * (x - y), s * (w - z)};
}

Geodetic place_of(const Geodetic& home, const Vector3& ned) {
  constexpr double radius = 6371000.0;  // [m], CONSTANTS_RADIUS_OF_EARTH of PX4
  const double north = ned[0] / radius, east = ned[1] / radius;
  const double angle = std::sqrt(north * north + east * east);
  Geodetic place = home;
  place.altitude -= ned[2];
  if (angle == 0.0) return place;
  const double latitude = radians(home.latitude);
  const double sine = std::sin(angle), cosine = std::cos(angle);
  place.latitude = degrees(std::asin(cosine * std::sin(latitude) + north * sine * std::cos(latitude) / angle));
  place.longitude +=
      degrees(std::atan2(east * sine, angle * std::cos(latitude) * cosine - north * std::sin(latitude) * sine));
  return place;
}

double pressure_altitude(double pressure) {
  return temperature / lapse_rate * (1.0 - std::pow(pressure / at_sea, 1.0 / exponent));
}

double pressure_at(double altitude) { return at_sea * std::pow(1.0 - lapse_rate * altitude / temperature, exponent); }

}  // namespace cohort::autopilots
