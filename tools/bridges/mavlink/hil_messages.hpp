// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <tuple>

/// The MAVLink messages that bridges use, as defined in MAVLink's common.xml. Fields are in the order of the wire:
/// sorted by size, extensions last. `crc_extra` is the checksum of the message's definition.
namespace cohort::mavlink {

struct Heartbeat {
  static constexpr std::uint32_t id = 0;
  static constexpr std::uint8_t crc_extra = 50;
  std::uint32_t custom_mode = 0;
  std::uint8_t type = 0;
  std::uint8_t autopilot = 0;
  std::uint8_t base_mode = 0;
  std::uint8_t system_status = 0;
  std::uint8_t mavlink_version = 3;

  static auto fields(auto& m) {
    return std::tie(m.custom_mode, m.type, m.autopilot, m.base_mode, m.system_status, m.mavlink_version);
  }
};

struct CommandLong {
  static constexpr std::uint32_t id = 76;
  static constexpr std::uint8_t crc_extra = 152;
  std::array<float, 7> parameters{};
  std::uint16_t command = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t confirmation = 0;

  static auto fields(auto& m) {
    return std::tie(m.parameters, m.command, m.target_system, m.target_component, m.confirmation);
  }
};

struct HilActuatorControls {
  static constexpr std::uint32_t id = 93;
  static constexpr std::uint8_t crc_extra = 47;
  std::uint64_t time_usec = 0;
  std::uint64_t flags = 0;
  std::array<float, 16> controls{};  ///< -1 to 1, or 0 to 1 for an actuator that does not reverse
  std::uint8_t mode = 0;

  static auto fields(auto& m) { return std::tie(m.time_usec, m.flags, m.controls, m.mode); }
};

struct HilSensor {
  static constexpr std::uint32_t id = 107;
  static constexpr std::uint8_t crc_extra = 108;
  std::uint64_t time_usec = 0;
  std::array<float, 3> acceleration{};    ///< FRD [m/s^2]
  std::array<float, 3> turn_rate{};       ///< FRD [rad/s]
  std::array<float, 3> magnetic_field{};  ///< FRD [gauss]
  float absolute_pressure = 0;            ///< [hPa]
  float differential_pressure = 0;        ///< [hPa]
  float pressure_altitude = 0;            ///< [m]
  float temperature = 0;                  ///< [degrees Celsius]
  std::uint32_t fields_updated = 0;
  std::uint8_t sensor = 0;

  static auto fields(auto& m) {
    return std::tie(m.time_usec, m.acceleration, m.turn_rate, m.magnetic_field, m.absolute_pressure,
                    m.differential_pressure, m.pressure_altitude, m.temperature, m.fields_updated, m.sensor);
  }
};

struct HilGps {
  static constexpr std::uint32_t id = 113;
  static constexpr std::uint8_t crc_extra = 124;
  std::uint64_t time_usec = 0;
  std::int32_t latitude = 0;               ///< [1e-7 degrees]
  std::int32_t longitude = 0;              ///< [1e-7 degrees]
  std::int32_t altitude = 0;               ///< above mean sea level [mm]
  std::uint16_t eph = 0;                   ///< [cm], as PX4 reads it
  std::uint16_t epv = 0;                   ///< [cm], as PX4 reads it
  std::uint16_t speed = 0;                 ///< over ground [cm/s]
  std::array<std::int16_t, 3> velocity{};  ///< NED [cm/s]
  std::uint16_t course = 0;                ///< over ground [0.01 degrees]; 65535: unknown
  std::uint8_t fix_type = 0;
  std::uint8_t satellites_visible = 0;
  std::uint8_t receiver = 0;
  std::uint16_t yaw = 0;  ///< [0.01 degrees]; 0: none

  static auto fields(auto& m) {
    return std::tie(m.time_usec, m.latitude, m.longitude, m.altitude, m.eph, m.epv, m.speed, m.velocity, m.course,
                    m.fix_type, m.satellites_visible, m.receiver, m.yaw);
  }
};

struct HilStateQuaternion {
  static constexpr std::uint32_t id = 115;
  static constexpr std::uint8_t crc_extra = 4;
  std::uint64_t time_usec = 0;
  std::array<float, 4> attitude{1};            ///< w x y z, FRD to NED
  std::array<float, 3> turn_rate{};            ///< FRD [rad/s]
  std::int32_t latitude = 0;                   ///< [1e-7 degrees]
  std::int32_t longitude = 0;                  ///< [1e-7 degrees]
  std::int32_t altitude = 0;                   ///< [mm]
  std::array<std::int16_t, 3> velocity{};      ///< NED [cm/s]
  std::uint16_t indicated_airspeed = 0;        ///< [cm/s]
  std::uint16_t true_airspeed = 0;             ///< [cm/s]
  std::array<std::int16_t, 3> acceleration{};  ///< FRD [mg]

  static auto fields(auto& m) {
    return std::tie(m.time_usec, m.attitude, m.turn_rate, m.latitude, m.longitude, m.altitude, m.velocity,
                    m.indicated_airspeed, m.true_airspeed, m.acceleration);
  }
};

}  // namespace cohort::mavlink
