// SPDX-License-Identifier: Apache-2.0
#include "tests/bridges/epuck2_program.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "tests/support/patience.hpp"

namespace cohort::test {
namespace {

constexpr std::size_t sensors_size = 104;

}  // namespace

EpuckProgram::EpuckProgram(std::uint16_t port, const std::string& address)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const timeval at_most{test::patience.count(), 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &at_most, sizeof at_most);
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &at_most, sizeof at_most);
  sockaddr_in robot{};
  robot.sin_family = AF_INET;
  robot.sin_port = htons(port);
  ::inet_pton(AF_INET, address.c_str(), &robot.sin_addr);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&robot), sizeof robot) != 0) {
    ::close(socket_);
    throw std::runtime_error("no robot at port " + std::to_string(port));
  }
}

EpuckProgram::EpuckProgram(EpuckProgram&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

EpuckProgram::~EpuckProgram() {
  if (socket_ >= 0) ::close(socket_);
}

Bytes EpuckProgram::command(int left, int right, std::uint8_t request) {
  Bytes bytes(21, 0);
  bytes[0] = 0x80;
  bytes[1] = request;
  bytes[3] = static_cast<std::uint8_t>(left & 0xff);
  bytes[4] = static_cast<std::uint8_t>(left >> 8 & 0xff);
  bytes[5] = static_cast<std::uint8_t>(right & 0xff);
  bytes[6] = static_cast<std::uint8_t>(right >> 8 & 0xff);
  return bytes;
}

void EpuckProgram::send(const Bytes& bytes) const {
  if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the robot does not take it");
  }
}

Bytes EpuckProgram::receive(std::size_t count) const {
  Bytes bytes(count);
  std::size_t received = 0;
  while (received < count) {
    const ssize_t more = ::recv(socket_, bytes.data() + received, count - received, 0);
    if (more < 0 && errno != ECONNRESET) throw std::runtime_error("the robot does not answer");
    if (more <= 0) break;
    received += static_cast<std::size_t>(more);
  }
  bytes.resize(received);
  return bytes;
}

Bytes EpuckProgram::receive_sensors() const {
  if (receive(1) != Bytes{0x02}) throw std::runtime_error("no sensors packet came");
  Bytes values = receive(sensors_size);
  if (values.size() != sensors_size) throw std::runtime_error("the sensors packet was cut short");
  return values;
}

int unsigned_16(const Bytes& sensors, std::size_t place) { return sensors.at(place) | sensors.at(place + 1) << 8; }

int signed_16(const Bytes& sensors, std::size_t place) {
  return static_cast<std::int16_t>(unsigned_16(sensors, place));
}

float real_32(const Bytes& sensors, std::size_t place) {
  float value = 0.0F;
  std::memcpy(&value, &sensors.at(place), sizeof value);  // this machine is little-endian, as the robot is
  return value;
}

std::array<int, 8> proximity(const Bytes& sensors) {
  std::array<int, 8> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = unsigned_16(sensors, 37 + 2 * i);
  return values;
}

std::array<int, 2> avoid_obstacles(const Bytes& sensors) {
  constexpr int full_speed = 400;
  constexpr int turning_speed = 200;
  constexpr int too_near = 100;
  const std::array<int, 8> near = proximity(sensors);
  const int right = std::max({near[0], near[1], near[2] / 4});
  const int left = std::max({near[7], near[6], near[5] / 4});
  // On the spot, and always the same way: one that chose the freer side would swing to and fro in a corner for ever.
  if (std::max(left, right) > too_near) return {-turning_speed, turning_speed};
  return {full_speed - 3 * right, full_speed - 3 * left};
}

}  // namespace cohort::test
