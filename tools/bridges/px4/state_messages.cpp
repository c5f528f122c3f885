// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/px4/state_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cohort::px4 {
namespace {

using autopilots::Geodetic;
using autopilots::Motion;
using autopilots::Vector3;

constexpr double gauss_in_a_tesla = 1e4;
constexpr double standard_gravity = 9.80665;  // [m/s^2]
constexpr float room_temperature = 25.0F;     // [degrees Celsius]

template <class Integer>
Integer rounded(double value) {
  return static_cast<Integer>(std::llround(
      std::clamp<double>(value, std::numeric_limits<Integer>::min(), std::numeric_limits<Integer>::max())));
}

template <std::size_t size>
std::array<float, size> floats(const std::array<double, size>& values, double scale = 1.0) {
  std::array<float, size> result{};
  for (std::size_t i = 0; i < size; ++i) result[i] = static_cast<float>(scale * values[i]);
  return result;
}

std::array<std::int16_t, 3> counts(const Vector3& values, double scale) {
  return {rounded<std::int16_t>(scale * values[0]), rounded<std::int16_t>(scale * values[1]),
          rounded<std::int16_t>(scale * values[2])};
}

template <class Message>
void set_place(Message& message, const Geodetic& place) {
  message.latitude = rounded<std::int32_t>(1e7 * place.latitude);
  message.longitude = rounded<std::int32_t>(1e7 * place.longitude);
  message.altitude = rounded<std::int32_t>(1e3 * place.altitude);
}

// Clockwise from north, in hundredths of a degree.
std::uint16_t course_of(const Vector3& velocity) {
  const double degrees = std::atan2(velocity[1], velocity[0]) * 180.0 / std::numbers::pi;
  return static_cast<std::uint16_t>(std::llround(100.0 * degrees + 36000.0) % 36000);
}

}  // namespace

mavlink::HilSensor sensor_message(std::uint64_t time, const Motion& motion, const Vector3& magnetic_field,
                                  double pressure, const Geodetic& home) {
  // Accelerometer, gyroscope and magnetometer have three bits each, then pressure, altitude and temperature; that of
  // the differential pressure, which is not measured, is between.
  constexpr std::uint32_t updated = 0x1ff | 1 << 9 | 1 << 11 | 1 << 12;
  mavlink::HilSensor message;
  message.time_usec = time;
  message.acceleration = floats(motion.acceleration);
  message.turn_rate = floats(motion.turn_rate);
  message.magnetic_field = floats(magnetic_field, gauss_in_a_tesla);
  const double altitude = home.altitude + autopilots::pressure_altitude(pressure);
  message.absolute_pressure = static_cast<float>(autopilots::pressure_at(altitude) / 100.0);
  message.pressure_altitude = static_cast<float>(altitude);
  message.temperature = room_temperature;
  message.fields_updated = updated;
  return message;
}

mavlink::HilGps gps_message(std::uint64_t time, const Motion& motion, const Geodetic& home) {
  mavlink::HilGps message;
  message.time_usec = time;
  set_place(message, autopilots::place_of(home, motion.position));
  message.eph = 90;
  message.epv = 90;
  message.velocity = counts(motion.velocity, 100.0);
  message.speed = rounded<std::uint16_t>(100.0 * std::hypot(motion.velocity[0], motion.velocity[1]));
  message.course = course_of(motion.velocity);
  message.fix_type = 3;
  message.satellites_visible = 10;
  return message;
}

mavlink::HilStateQuaternion state_message(std::uint64_t time, const Motion& motion, const Geodetic& home) {
  mavlink::HilStateQuaternion message;
  message.time_usec = time;
  message.attitude = floats(motion.attitude);
  message.turn_rate = floats(motion.turn_rate);
  set_place(message, autopilots::place_of(home, motion.position));
  message.velocity = counts(motion.velocity, 100.0);
  message.acceleration = counts(motion.acceleration, 1000.0 / standard_gravity);
  return message;
}

}  // namespace cohort::px4
