// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/betaflight/sitl_packets.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace cohort::betaflight {
namespace {

static_assert(std::endian::native == std::endian::little, "the program's packets are the memory of its machine");

// On a sphere with the radius of the equator.
constexpr double meters_in_a_degree = 111319.49;

template <class Value>
void append(std::vector<std::uint8_t>& packet, Value value) {
  std::array<std::uint8_t, sizeof value> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  packet.insert(packet.end(), bytes.begin(), bytes.end());
}

}  // namespace

std::vector<std::uint8_t> state_packet(const State& state) {
  std::vector<std::uint8_t> packet;
  packet.reserve(state_size);
  append(packet, state.time);
  // Forward, right, down.
  append(packet, state.angular_velocity[0]);
  append(packet, -state.angular_velocity[1]);
  append(packet, -state.angular_velocity[2]);
  for (const double value : state.acceleration) append(packet, -value);
  // From forward, right, down to north, east, down: the program turns two signs of its matrix for it.
  append(packet, state.orientation[0]);
  append(packet, state.orientation[1]);
  append(packet, -state.orientation[2]);
  append(packet, -state.orientation[3]);
  // East, north, up; then longitude and latitude [degrees], altitude.
  append(packet, -state.velocity[1]);
  append(packet, state.velocity[0]);
  append(packet, state.velocity[2]);
  append(packet, -state.position[1] / meters_in_a_degree);
  append(packet, state.position[0] / meters_in_a_degree);
  append(packet, state.position[2]);
  append(packet, state.pressure);
  return packet;
}

std::vector<std::uint8_t> rc_packet(double time, const Channels& channels) {
  std::vector<std::uint8_t> packet;
  packet.reserve(rc_size);
  append(packet, time);
  for (const std::uint16_t channel : channels) append(packet, channel);
  return packet;
}

Motors motors_in(std::span<const std::uint8_t> packet) {
  // The packet has the order of another simulator's copter: motors 2, 3, 4 and 1.
  constexpr std::array<std::size_t, 4> place_of_motor{3, 0, 1, 2};
  Motors motors{};
  for (std::size_t motor = 0; motor < motors.size(); ++motor) {
    float value = 0.0F;
    std::memcpy(&value, packet.subspan(place_of_motor[motor] * sizeof value).data(), sizeof value);
    if (!(value >= -1.0F && value <= 1.0F))
      throw std::runtime_error("motor " + std::to_string(motor + 1) + " has the command " + std::to_string(value) +
                               ", expected 0 to 1");
    motors[motor] = value;
  }
  return motors;
}

}  // namespace cohort::betaflight
