// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// The packets of Betaflight's SITL program (docs/bridges/betaflight.md), as in its source code. Pure functions.
namespace cohort::betaflight {

inline constexpr std::uint16_t servo_port = 9002;  // the program sends there
inline constexpr std::uint16_t state_port = 9003;  // the program listens
inline constexpr std::uint16_t rc_port = 9004;     // the program listens
inline constexpr std::uint16_t cli_port = 5761;    // the program listens, TCP
inline constexpr std::size_t state_size = 144;
inline constexpr std::size_t rc_size = 40;
inline constexpr std::size_t servo_size = 16;

using Vector = std::array<double, 3>;

/// Measurements of a flight controller's sensors. The axes of the body are x forward, y left, z up.
struct State {
  double time = 0.0;                                      ///< [s]
  Vector angular_velocity{};                              ///< body rates, in body axes [rad/s]
  Vector acceleration{};                                  ///< specific force, in body axes [m/s^2]
  std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};  ///< w x y z, from the body to north-west-up
  Vector velocity{};                                      ///< in north-west-up [m/s]
  Vector position{};                                      ///< relative to the start, in north-west-up [m]
  double pressure = 101325.0;                             ///< [Pa]
};

/// The state packet, which the program calls fdm_packet.
std::vector<std::uint8_t> state_packet(const State& state);

/// Pulses of a remote control, 1000 to 2000 [us]: roll, pitch, throttle, yaw, AUX1 to AUX12.
using Channels = std::array<std::uint16_t, 16>;
std::vector<std::uint8_t> rc_packet(double time, const Channels& channels);

/// Motors in the order of Betaflight's mixer QUADX: rear right, front right, rear left, front left; 0 to 1.
using Motors = std::array<double, 4>;
/// Decodes the `servo_size` bytes of a servo packet. Throws std::runtime_error if a value is outside [-1, 1].
Motors motors_in(std::span<const std::uint8_t> packet);

}  // namespace cohort::betaflight
