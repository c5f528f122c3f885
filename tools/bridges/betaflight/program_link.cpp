// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/betaflight/program_link.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "tools/bridges/betaflight/sitl_packets.hpp"
#include "tools/bridges/common/descriptor.hpp"
#include "tools/bridges/common/sockets.hpp"

namespace cohort::betaflight {
namespace {

constexpr int most_mistakes_told = 10;
constexpr std::chrono::milliseconds answered_within{100};

std::string place_text(const sockaddr_in& endpoint) {
  char text[INET_ADDRSTRLEN] = {};
  ::inet_ntop(AF_INET, &endpoint.sin_addr, text, sizeof text);
  return std::string(text) + ":" + std::to_string(ntohs(endpoint.sin_port));
}

/// Waits for the end of a connect() that does not block. Returns its error: 0 if it has connected.
int error_of_connecting(const bridges::Descriptor& socket) {
  pollfd waited{socket.number(), POLLOUT, 0};
  if (::poll(&waited, 1, static_cast<int>(answered_within.count())) <= 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(socket.number(), SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

}  // namespace

bool has_booted(const std::string& address) {
  const sockaddr_in endpoint = bridges::endpoint_of(address, cli_port);
  const bridges::Descriptor caller(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  int error = 0;
  if (::connect(caller.number(), reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) != 0) error = errno;
  if (error == EINPROGRESS) error = error_of_connecting(caller);
  return error != ECONNREFUSED;
}

bridges::Descriptor open_servo_socket(const std::string& address) {
  const sockaddr_in endpoint = bridges::endpoint_of(address, servo_port);
  bridges::Descriptor bound(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (::bind(bound.number(), reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) != 0)
    throw std::runtime_error("cannot listen on " + place_text(endpoint) + ": " + bridges::text_of_error(errno));
  return bound;
}

ProgramLink::ProgramLink(bridges::Descriptor socket, const std::string& address)
    : socket_(std::move(socket)), program_(bridges::endpoint_of(address, state_port)) {}

std::string ProgramLink::place() const {
  sockaddr_in endpoint{};
  socklen_t size = sizeof endpoint;
  ::getsockname(socket_.number(), reinterpret_cast<sockaddr*>(&endpoint), &size);
  return place_text(endpoint);
}

std::string ProgramLink::peer() const { return place_text(program_); }

std::size_t ProgramLink::read(std::span<std::uint8_t> bytes) {
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t count =
      ::recvfrom(socket_.number(), bytes.data(), bytes.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
  if (count < 0) return 0;
  if (from.sin_addr.s_addr != program_.sin_addr.s_addr) return 0;
  if (count == static_cast<ssize_t>(servo_size)) return servo_size;
  if (++mistakes_ > most_mistakes_told) return 0;
  throw bridges::LinkLost("has sent a datagram of " + std::to_string(count) +
                          " bytes, which is not a servo packet: expected " + std::to_string(servo_size));
}

std::size_t ProgramLink::write(std::span<const std::uint8_t> bytes) {
  sockaddr_in to = program_;
  to.sin_port = htons(bytes.size() == rc_size ? rc_port : state_port);
  const ssize_t count =
      ::sendto(socket_.number(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  if (count < 0 && bridges::is_for_later(errno)) return 0;
  return bytes.size();  // datagrams without a receiver are lost
}

}  // namespace cohort::betaflight
