// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "tools/bridges/autopilots/autopilot_outputs.hpp"
#include "tools/bridges/autopilots/vehicle_motion.hpp"

/// The packets of ArduPilot's JSON interface (docs/bridges/ardupilot.md). Pure functions.
namespace cohort::ardupilot {

/// The packet that SITL sends at each of its steps.
struct ServoPacket {
  std::uint16_t frame_rate = 0;   ///< requested step rate [Hz]
  std::uint32_t frame_count = 0;  ///< number of the step, increased by one at each step
  autopilots::Shares shares{};    ///< 0 for a pulse of 1000 us, 1 for 2000 us; nullopt without a pulse
};

/// Returns the size of the packet in a datagram [bytes]. Throws std::runtime_error if the datagram is not a servo
/// packet.
std::size_t servo_packet_size(std::span<const std::uint8_t> datagram);

/// Decodes a datagram for which `servo_packet_size` does not throw.
ServoPacket decode(std::span<const std::uint8_t> datagram);

/// Returns the line of JSON that answers a packet.
std::string answer_line(std::chrono::nanoseconds time, const autopilots::Motion& motion);

}  // namespace cohort::ardupilot
