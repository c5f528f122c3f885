// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/epuck2/packets.hpp"

#include <bit>
#include <cstdio>

namespace cohort::epuck2 {
namespace {

constexpr std::uint8_t command_id = 0x80;
constexpr std::uint8_t image_id = 0x01;
constexpr std::uint8_t sensors_id = 0x02;
constexpr std::uint8_t empty_id = 0x03;
constexpr std::uint8_t known_requests = 0x03;

std::string hexadecimal(std::uint8_t byte) {
  std::array<char, 5> text{};
  std::snprintf(text.data(), text.size(), "0x%02x", byte);
  return text.data();
}

bool has_bit(std::uint8_t byte, int bit) { return (byte >> bit & 1) != 0; }

std::int16_t int16_at(std::span<const std::uint8_t> bytes, std::size_t place) {
  return static_cast<std::int16_t>(bytes[place] | bytes[place + 1] << 8);
}

// Little-endian, one field after the other.
class PacketWriter {
 public:
  explicit PacketWriter(std::uint8_t id) : bytes_{id} {}
  void write(std::uint8_t value) { bytes_.push_back(value); }
  void write(std::int8_t value) { write(static_cast<std::uint8_t>(value)); }
  void write(std::uint16_t value) {
    write(static_cast<std::uint8_t>(value & 0xff));
    write(static_cast<std::uint8_t>(value >> 8));
  }
  void write(std::int16_t value) { write(static_cast<std::uint16_t>(value)); }
  void write(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    write(static_cast<std::uint16_t>(bits & 0xffff));
    write(static_cast<std::uint16_t>(bits >> 16));
  }
  template <class Value, std::size_t count>
  void write(const std::array<Value, count>& values) {
    for (const Value value : values) write(value);
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::optional<std::string> mistake_of(std::span<const std::uint8_t> begun) {
  if (!begun.empty() && begun[0] != command_id) {
    return "a command begins with " + hexadecimal(command_id) + ", not with " + hexadecimal(begun[0]);
  }
  if (begun.size() > 1 && (begun[1] & ~known_requests) != 0) {
    return "request " + hexadecimal(begun[1]) + ": expected image (1), sensors (2) or both (3)";
  }
  return std::nullopt;
}

Command decode(std::span<const std::uint8_t> bytes) {
  Command command;
  command.wants_image = has_bit(bytes[1], 0);
  command.wants_sensors = has_bit(bytes[1], 1);
  command.calibrates = has_bit(bytes[2], 0);
  command.avoids_obstacles = has_bit(bytes[2], 1);
  command.sets_steps = has_bit(bytes[2], 2);
  command.left = int16_at(bytes, 3);
  command.right = int16_at(bytes, 5);
  for (std::size_t led = 0; led < command.red_leds.size(); ++led) {
    command.red_leds[led] = has_bit(bytes[7], static_cast<int>(led));
  }
  command.body_led = has_bit(bytes[7], 4);
  command.front_led = has_bit(bytes[7], 5);
  for (std::size_t led = 0; led < command.rgb_leds.size(); ++led) {
    for (std::size_t color = 0; color < 3; ++color) command.rgb_leds[led][color] = bytes[8 + 3 * led + color];
  }
  command.sound = bytes[20];
  return command;
}

std::vector<std::uint8_t> sensors_packet(const Sensors& sensors) {
  PacketWriter packet(sensors_id);
  packet.write(sensors.acceleration);
  packet.write(sensors.acceleration_size);
  packet.write(sensors.orientation);
  packet.write(sensors.inclination);
  packet.write(sensors.angular_velocity);
  packet.write(sensors.magnetic_field);
  packet.write(sensors.temperature);
  packet.write(sensors.proximity);
  packet.write(sensors.ambient_light);
  packet.write(sensors.distance);
  packet.write(sensors.microphones);
  packet.write(sensors.steps);
  packet.write(sensors.battery);
  packet.write(sensors.has_micro_sd);
  packet.write(sensors.remote_control);
  packet.write(sensors.selector);
  packet.write(sensors.ground);
  packet.write(sensors.ground_light);
  packet.write(sensors.button);
  packet.write(std::uint8_t{0});
  return packet.take();
}

std::vector<std::uint8_t> image_packet() {
  constexpr std::size_t bytes_of_a_pixel = 2;
  std::vector<std::uint8_t> packet(1 + bytes_of_a_pixel * image_width * image_height, 0);
  packet[0] = image_id;
  return packet;
}

std::vector<std::uint8_t> empty_packet() { return {empty_id}; }

}  // namespace cohort::epuck2
