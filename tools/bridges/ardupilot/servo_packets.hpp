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
  std::uint16_t frame_rate = 0;   ///< steps that it would like to make in a second
  std::uint32_t frame_count = 0;  ///< goes up by one at each step
  autopilots::Shares shares{};    ///< 0 at a pulse of 1000 us, 1 at 2000 us; none without a pulse
};

/// Returns the size of the packet that a datagram is. Throws std::runtime_error if it is none.
std::size_t servo_packet_size(std::span<const std::uint8_t> datagram);

/// Decodes a datagram that `servo_packet_size` takes.
ServoPacket decode(std::span<const std::uint8_t> datagram);

/// Returns the line of JSON that answers a packet.
std::string answer_line(std::chrono::nanoseconds time, const autopilots::Motion& motion);

}  // namespace cohort::ardupilot
