// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ardupilot/servo_packets.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace cohort::ardupilot {
namespace {

constexpr std::size_t header_size = 8;
constexpr std::uint16_t magic_of_16 = 18458;
constexpr std::uint16_t magic_of_32 = 29569;

std::uint16_t uint16_at(std::span<const std::uint8_t> bytes, std::size_t place) {
  return static_cast<std::uint16_t>(bytes[place] | bytes[place + 1] << 8);
}

// The shortest text that is read back as the same number.
void append(std::string& text, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

// Without blanks: the parser looks for these very characters.
template <std::size_t size>
void append(std::string& text, const char* key, const std::array<double, size>& values) {
  text += std::string("\"") + key + "\":[";
  for (std::size_t i = 0; i < size; ++i) {
    if (i > 0) text += ',';
    append(text, values[i]);
  }
  text += ']';
}

}  // namespace

std::size_t servo_packet_size(std::span<const std::uint8_t> datagram) {
  const std::string size = std::to_string(datagram.size());
  if (datagram.size() < header_size) throw std::runtime_error("a servo packet has 40 or 72 bytes, not " + size);
  const std::uint16_t magic = uint16_at(datagram, 0);
  if (magic != magic_of_16 && magic != magic_of_32)
    throw std::runtime_error("a servo packet begins with 18458 or 29569, not with " + std::to_string(magic));
  const std::size_t channels = magic == magic_of_16 ? 16 : 32;
  const std::size_t expected = header_size + 2 * channels;
  if (datagram.size() != expected)
    throw std::runtime_error("a servo packet of " + std::to_string(channels) + " channels has " +
                             std::to_string(expected) + " bytes, not " + size);
  return expected;
}

ServoPacket decode(std::span<const std::uint8_t> datagram) {
  ServoPacket packet;
  packet.frame_rate = uint16_at(datagram, 2);
  packet.frame_count = uint16_at(datagram, 4) | static_cast<std::uint32_t>(uint16_at(datagram, 6)) << 16;
  for (std::size_t i = 0; header_size + 2 * i < datagram.size(); ++i) {
    const std::uint16_t pulse = uint16_at(datagram, header_size + 2 * i);
    if (pulse > 0) packet.shares[i] = std::clamp((pulse - 1000.0) / 1000.0, 0.0, 1.0);
  }
  return packet;
}

std::string answer_line(std::chrono::nanoseconds time, const autopilots::Motion& motion) {
  std::string text = "\n{\"timestamp\":";
  append(text, std::chrono::duration<double>(time).count());
  text += ",\"imu\":{";
  append(text, "gyro", motion.turn_rate);
  text += ',';
  append(text, "accel_body", motion.acceleration);
  text += "},";
  append(text, "position", motion.position);
  text += ',';
  append(text, "quaternion", motion.attitude);
  text += ',';
  append(text, "velocity", motion.velocity);
  return text + "}\n";
}

}  // namespace cohort::ardupilot
