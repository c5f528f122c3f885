#include "tools/bridges/epuck2/port.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "client_sdk/hosting/controller_host.hpp"

namespace cohort::epuck2 {
namespace {

constexpr int given_up_is_asked_every = 100;  // ms

std::string text_of(int error) { return std::generic_category().message(error); }

Socket listen_at(const std::string& address, std::uint16_t port) {
  const std::string place = address + ":" + std::to_string(port);
  sockaddr_in endpoint{};
  endpoint.sin_family = AF_INET;
  endpoint.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &endpoint.sin_addr) != 1) {
    throw std::runtime_error("'" + address + "' is no IPv4 address");
  }
  Socket listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  ::setsockopt(listener.descriptor(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(listener.descriptor(), reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) != 0 ||
      ::listen(listener.descriptor(), 1) != 0) {
    const int error = errno;
    throw std::runtime_error(
        "cannot listen at " + place + ": " + text_of(error) +
        (error == EACCES ? ". Ports below 1024 may be reserved to root: give another --port" : ""));
  }
  return listener;
}

std::uint16_t port_of(const Socket& listener) {
  sockaddr_in endpoint{};
  socklen_t size = sizeof endpoint;
  ::getsockname(listener.descriptor(), reinterpret_cast<sockaddr*>(&endpoint), &size);
  return ntohs(endpoint.sin_port);
}

bool is_for_later(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

Socket::Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

Socket::~Socket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Port::Port(const std::string& address, std::uint16_t port, Callbacks callbacks)
    : callbacks_(std::move(callbacks)), listener_(listen_at(address, port)), number_(port_of(listener_)) {}

std::optional<Command> Port::next_command(Patience patience) {
  const bool for_ever = patience == Patience::until_a_command_comes;
  while (program_ || accept(for_ever)) {
    if (auto command = receive()) return command;
    if (!for_ever) return std::nullopt;
  }
  return std::nullopt;
}

void Port::send(std::span<const std::uint8_t> packet) {
  while (program_ && !packet.empty()) {
    const ssize_t sent = ::send(program_->descriptor(), packet.data(), packet.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      packet = packet.subspan(static_cast<std::size_t>(sent));
    } else if (is_for_later(errno)) {
      wait_for(program_->descriptor(), POLLOUT);
    } else {
      hang_up("does not take its answer: " + text_of(errno));
    }
  }
}

bool Port::accept(bool wait) {
  for (;;) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    Socket program(
        ::accept4(listener_.descriptor(), reinterpret_cast<sockaddr*>(&from), &size, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (program.descriptor() >= 0) {
      // A command and its answer are one small packet each, and both sides wait for them.
      const int on = 1;
      ::setsockopt(program.descriptor(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      program_ = std::move(program);
      char text[INET_ADDRSTRLEN] = {};
      ::inet_ntop(AF_INET, &from.sin_addr, text, sizeof text);
      callbacks_.tell("a program has connected from " + std::string(text));
      return true;
    }
    if (!wait) return false;
    wait_for(listener_.descriptor(), POLLIN);
  }
}

std::optional<Command> Port::receive() {
  CommandBytes bytes{};
  std::size_t received = 0;
  while (received < bytes.size()) {
    const ssize_t count = ::recv(program_->descriptor(), bytes.data() + received, bytes.size() - received, 0);
    if (count > 0) {
      received += static_cast<std::size_t>(count);
      if (const auto mistake = mistake_of({bytes.data(), received})) {
        hang_up("is cut off: " + *mistake);
        return std::nullopt;
      }
    } else if (count == 0) {
      hang_up(received == 0 ? "has left"
                            : "has left in the midst of a command, after " + std::to_string(received) + " of " +
                                  std::to_string(bytes.size()) + " bytes");
      return std::nullopt;
    } else if (is_for_later(errno)) {
      wait_for(program_->descriptor(), POLLIN);
    } else {
      hang_up("is lost: " + text_of(errno));
      return std::nullopt;
    }
  }
  return decode(bytes);
}

void Port::hang_up(const std::string& why) {
  program_.reset();
  callbacks_.tell("the program " + why);
}

void Port::wait_for(int descriptor, short event) const {
  if (callbacks_.given_up()) throw LeaveRun{};
  pollfd waited{descriptor, event, 0};
  ::poll(&waited, 1, given_up_is_asked_every);
}

}  // namespace cohort::epuck2
