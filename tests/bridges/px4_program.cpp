// SPDX-License-Identifier: Apache-2.0
#include "tests/bridges/px4_program.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include "tests/support/patience.hpp"
#include "tools/bridges/mavlink/payload.hpp"

namespace cohort::test {
namespace {

constexpr double metres_in_a_degree = 111194.92664455874;  // on a sphere of 6371 km
constexpr double home_latitude = 47.397742, home_longitude = 8.545594, home_altitude = 488.0;

}  // namespace

Px4Program::Px4Program(std::uint16_t port, int boot, bool counts_from_first)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), boot_(boot), counts_from_first_(counts_from_first) {
  const timeval at_most{patience.count(), 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &at_most, sizeof at_most);
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  sockaddr_in bridge{};
  bridge.sin_family = AF_INET;
  bridge.sin_port = htons(port);
  ::inet_pton(AF_INET, "127.0.0.1", &bridge.sin_addr);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&bridge), sizeof bridge) != 0) {
    ::close(socket_);
    throw std::runtime_error("no bridge at port " + std::to_string(port));
  }
  mavlink::CommandLong ask;
  ask.command = 511;
  ask.parameters = {115, 4000};
  send(ask);
  mavlink::Heartbeat heartbeat;
  heartbeat.autopilot = 12;
  send(heartbeat);
}

Px4Program::~Px4Program() { ::close(socket_); }

void Px4Program::send_bytes(const std::vector<std::uint8_t>& bytes) const {
  ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void Px4Program::leave() {
  ::shutdown(socket_, SHUT_WR);
  while (receive()) {
  }
}

template <class Message>
void Px4Program::send(const Message& message) {
  send_bytes(mavlink::frame_of({sequence_++, 1, 1, Message::id, mavlink::payload_of(message)}, Message::crc_extra));
}

bool Px4Program::receive() {
  std::uint8_t bytes[4096];
  const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
  if (count < 0 && errno != ECONNRESET) throw std::runtime_error("the bridge sends nothing");
  if (count <= 0) return false;
  received_.insert(received_.end(), bytes, bytes + count);
  return true;
}

void Px4Program::take(const std::vector<std::uint8_t>& bytes) {
  const mavlink::Piece piece = mavlink::piece_of(bytes);
  if (!piece.packet || !piece.is_known) throw std::runtime_error("the bridge has sent no message");
  if (mavlink::message_in<mavlink::Heartbeat>(*piece.packet)) ++of_heartbeat;
  if (const auto message = mavlink::message_in<mavlink::HilGps>(*piece.packet)) {
    gps = *message;
    ++of_gps;
  }
  if (const auto state = mavlink::message_in<mavlink::HilStateQuaternion>(*piece.packet)) {
    ++of_state;
    seen.position = {
        (1e-7 * state->latitude - home_latitude) * metres_in_a_degree,
        (1e-7 * state->longitude - home_longitude) * metres_in_a_degree * std::cos(home_latitude / 57.29577951308232),
        home_altitude - 1e-3 * state->altitude};
    for (std::size_t i = 0; i < 3; ++i) {
      seen.velocity[i] = 1e-2 * state->velocity[i];
      seen.turn_rate[i] = state->turn_rate[i];
    }
    for (std::size_t i = 0; i < 4; ++i) seen.attitude[i] = state->attitude[i];
  }
  if (const auto message = mavlink::message_in<mavlink::HilSensor>(*piece.packet)) {
    if (has_sensor_) throw std::runtime_error("a second HIL_SENSOR before the first was answered");
    if (message->time_usec <= sensor.time_usec) throw std::runtime_error("time does not go on");
    // Sensors have noise, so their values only stay the same while the simulation waits.
    has_moved_ = has_moved_ || (first_ != 0 && message->acceleration != sensor.acceleration);
    if (!has_moved_) at_rest_until_ = message->time_usec;
    sensor = *message;
    has_sensor_ = true;
  }
}

// Returns how many HIL_SENSOR `received_` holds.
int Px4Program::waiting_sensors() const {
  int count = 0;
  std::span<const std::uint8_t> rest = received_;
  for (std::size_t size = 0; (size = mavlink::size_at(rest)) > 0 && size <= rest.size(); rest = rest.subspan(size)) {
    const mavlink::Piece piece = mavlink::piece_of(rest.first(size));
    if (piece.packet && mavlink::message_in<mavlink::HilSensor>(*piece.packet)) ++count;
  }
  return count;
}

bool Px4Program::step(Pilot pilot) {
  for (;;) {
    while (const std::size_t size = mavlink::size_at(received_)) {
      if (size > received_.size()) break;
      const auto end = received_.begin() + static_cast<std::ptrdiff_t>(size);
      const std::vector<std::uint8_t> bytes(received_.begin(), end);
      received_.erase(received_.begin(), end);
      take(bytes);
      if (!has_sensor_) continue;
      has_sensor_ = false;
      if (first_ == 0) first_ = sensor.time_usec;
      if (boot_-- > 0 || of_state == 0) continue;
      if (!std::exchange(has_answered_, true)) {
        while (waiting_sensors() < sensors_before_first_answer)
          if (!receive()) return false;
      }
      seen.time = 1e-6 * static_cast<double>(sensor.time_usec - at_rest_until_);
      const Outputs outputs = pilot(seen);
      mavlink::HilActuatorControls controls;
      controls.time_usec = sensor.time_usec - (counts_from_first_ ? first_ : 0);
      controls.flags = 1;
      controls.mode = 129;
      for (std::size_t i = 0; i < outputs.size(); ++i) controls.controls[i] = static_cast<float>(outputs[i]);
      if (steers_by_two_sides)
        controls.controls = {static_cast<float>(2 * outputs[2] - 1), static_cast<float>(2 * outputs[0] - 1)};
      send(controls);
      return true;
    }
    if (!receive()) return false;
  }
}

int Px4Program::fly(Pilot pilot, int at_most) {
  int steps = 0;
  while (steps < at_most && step(pilot)) ++steps;
  return steps;
}

}  // namespace cohort::test
