// SPDX-License-Identifier: Apache-2.0
#include "tests/bridges/sitl_program.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/patience.hpp"

namespace cohort::test {
namespace {

template <std::size_t size>
void read(const nlohmann::json& from, std::array<double, size>& values) {
  if (from.size() != size) throw std::runtime_error("not " + std::to_string(size) + " values: " + from.dump());
  for (std::size_t i = 0; i < size; ++i) values[i] = from[i];
}

}  // namespace

SitlProgram::SitlProgram(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in bridge{};
  bridge.sin_family = AF_INET;
  bridge.sin_port = htons(port);
  ::inet_pton(AF_INET, "127.0.0.1", &bridge.sin_addr);
  ::connect(socket_, reinterpret_cast<const sockaddr*>(&bridge), sizeof bridge);
}

SitlProgram::~SitlProgram() { ::close(socket_); }

std::vector<std::uint8_t> SitlProgram::packet(std::uint32_t frame_count, const Outputs& outputs, bool has_32) {
  std::vector<std::uint8_t> bytes;
  const auto add = [&](std::uint32_t value) {
    bytes.push_back(value & 0xff);
    bytes.push_back(value >> 8 & 0xff);
  };
  add(has_32 ? 29569 : 18458);
  add(400);
  add(frame_count);
  add(frame_count >> 16);
  for (std::size_t i = 0; i < (has_32 ? 32 : 16); ++i)
    add(i < outputs.size() ? static_cast<std::uint32_t>(std::lround(1000 + 1000 * outputs[i])) : 0);
  return bytes;
}

void SitlProgram::send(const std::vector<std::uint8_t>& datagram) const {
  if (::send(socket_, datagram.data(), datagram.size(), 0) < 0) refused_ = true;
}

std::optional<std::string> SitlProgram::receive(int milliseconds) const {
  pollfd waited{socket_, POLLIN, 0};
  if (::poll(&waited, 1, milliseconds) <= 0) return std::nullopt;
  char bytes[4096];
  const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
  if (count < 0) refused_ = true;
  if (count <= 0) return std::nullopt;
  return std::string(bytes, static_cast<std::size_t>(count));
}

bool SitlProgram::step(Pilot pilot) {
  const auto servos = packet(frame_count, pilot(seen), has_32);
  send(servos);
  constexpr double about_a_step = 0.0045;
  if (seen.time > run_ends_at - about_a_step) return false;
  std::optional<std::string> answer;
  for (int tenths = 0; !(answer = receive(100)); ++tenths) {
    if (refused_) return false;
    if (tenths > 10 * patience.count()) throw std::runtime_error("the bridge does not answer");
    if (tenths % 10 != 9) continue;
    send(servos);
    ++resent;
  }
  last_answer = *answer;
  if (answer->front() != '\n' || answer->back() != '\n') throw std::runtime_error("not a line: " + *answer);
  const auto json = nlohmann::json::parse(*answer);
  seen.time = json["timestamp"];
  read(json["imu"]["gyro"], seen.turn_rate);
  read(json["position"], seen.position);
  read(json["velocity"], seen.velocity);
  read(json["quaternion"], seen.attitude);
  ++frame_count;
  return true;
}

int SitlProgram::fly(Pilot pilot, int at_most) {
  int steps = 0;
  while (steps < at_most && step(pilot)) ++steps;
  return steps;
}

}  // namespace cohort::test
