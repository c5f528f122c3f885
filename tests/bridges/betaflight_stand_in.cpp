// SPDX-License-Identifier: Apache-2.0
#include "tests/bridges/betaflight_stand_in.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>

namespace cohort::test {
namespace {

sockaddr_in at(const std::string& address, std::uint16_t port) {
  sockaddr_in endpoint{};
  endpoint.sin_family = AF_INET;
  endpoint.sin_port = htons(port);
  ::inet_pton(AF_INET, address.c_str(), &endpoint.sin_addr);
  return endpoint;
}

int bound_to(const std::string& address, std::uint16_t port, int type = SOCK_DGRAM) {
  const int made = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
  const int yes = 1;
  if (type == SOCK_STREAM) ::setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in endpoint = at(address, port);
  if (::bind(made, reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) != 0)
    throw std::runtime_error(address + " cannot be listened at");
  return made;
}

bool has_datagram(int descriptor, int milliseconds) {
  pollfd waited{descriptor, POLLIN, 0};
  return ::poll(&waited, 1, milliseconds) > 0;
}

}  // namespace

BetaflightStandIn::BetaflightStandIn(std::uint32_t number)
    : prefix_("127.1." + std::to_string(number % 256) + "."),
      state_(bound_to(address(), 9003)),
      channels_(bound_to(address(), 9004)),
      command_line_(bound_to(address(), 5761, SOCK_STREAM)) {}

BetaflightStandIn::~BetaflightStandIn() {
  ::close(state_);
  ::close(channels_);
  ::close(command_line_);
}

void BetaflightStandIn::boot() const { ::listen(command_line_, SOMAXCONN); }

void BetaflightStandIn::shut_down() {
  ::close(command_line_);
  command_line_ = bound_to(address(), 5761, SOCK_STREAM);
}

std::optional<std::array<double, 18>> BetaflightStandIn::receive_state(int milliseconds) const {
  std::array<double, 18> state{};
  if (!has_datagram(state_, milliseconds)) return std::nullopt;
  if (::recv(state_, state.data(), sizeof state, MSG_TRUNC) != sizeof state)
    throw std::runtime_error("a state packet has 144 bytes");
  return state;
}

std::array<std::uint16_t, 16> BetaflightStandIn::receive_channels() const {
  std::array<std::uint8_t, 40> packet{};
  std::array<std::uint16_t, 16> channels{};
  do {
    if (::recv(channels_, packet.data(), packet.size(), MSG_TRUNC) != static_cast<ssize_t>(packet.size()))
      throw std::runtime_error("an RC packet has 40 bytes");
  } while (has_datagram(channels_, 0));
  std::memcpy(channels.data(), packet.data() + 8, sizeof channels);
  return channels;
}

void BetaflightStandIn::send(const std::vector<std::uint8_t>& datagram) const {
  const sockaddr_in to = at(simulator(), 9002);
  ::sendto(state_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

void BetaflightStandIn::command(const std::array<float, 4>& motors) const {
  std::vector<std::uint8_t> packet(sizeof motors);
  std::memcpy(packet.data(), motors.data(), packet.size());
  send(packet);
}

}  // namespace cohort::test
