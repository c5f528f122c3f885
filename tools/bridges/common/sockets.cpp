// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/common/sockets.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tools/bridges/common/descriptor.hpp"

namespace cohort::bridges {
namespace {

std::string text_of(const sockaddr_in& endpoint) {
  char text[INET_ADDRSTRLEN] = {};
  ::inet_ntop(AF_INET, &endpoint.sin_addr, text, sizeof text);
  return std::string(text) + ":" + std::to_string(ntohs(endpoint.sin_port));
}

const sockaddr* generic(const sockaddr_in& endpoint) { return reinterpret_cast<const sockaddr*>(&endpoint); }
sockaddr* generic(sockaddr_in& endpoint) { return reinterpret_cast<sockaddr*>(&endpoint); }

bool is_same(const sockaddr_in& a, const sockaddr_in& b) {
  return a.sin_addr.s_addr == b.sin_addr.s_addr && a.sin_port == b.sin_port;
}

Descriptor bind_socket(int type, const std::string& address, std::uint16_t port) {
  const sockaddr_in endpoint = endpoint_of(address, port);
  Descriptor bound(::socket(AF_INET, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  if (type == SOCK_STREAM) ::setsockopt(bound.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const bool is_bound = ::bind(bound.number(), generic(endpoint), sizeof endpoint) == 0 &&
                        (type != SOCK_STREAM || ::listen(bound.number(), 1) == 0);
  if (is_bound) return bound;
  const int error = errno;
  throw std::runtime_error("cannot listen on " + text_of(endpoint) + ": " + text_of_error(error) +
                           (error == EACCES ? ". Ports below 1024 may be reserved for root: choose another port" : ""));
}

std::string place_of(const Descriptor& bound) {
  sockaddr_in endpoint{};
  socklen_t size = sizeof endpoint;
  ::getsockname(bound.number(), generic(endpoint), &size);
  return text_of(endpoint);
}

class TcpLink final : public Link {
 public:
  TcpLink(const std::string& address, std::uint16_t port) : listener_(bind_socket(SOCK_STREAM, address, port)) {}

  std::string place() const override { return place_of(listener_); }
  std::string peer() const override { return peer_; }
  bool is_connectionless() const override { return false; }
  int descriptor() const override { return connection_.is_open() ? connection_.number() : listener_.number(); }

  bool connect() override {
    if (connection_.is_open()) return true;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    Descriptor accepted(::accept4(listener_.number(), generic(from), &size, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!accepted.is_open()) return false;
    // A message and its answer are one small packet each, and both sides wait for them.
    const int on = 1;
    ::setsockopt(accepted.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    connection_ = std::move(accepted);
    peer_ = text_of(from);
    return true;
  }

  std::size_t read(std::span<std::uint8_t> bytes) override {
    const ssize_t count = ::recv(connection_.number(), bytes.data(), bytes.size(), 0);
    if (count > 0) return static_cast<std::size_t>(count);
    if (count == 0) throw LinkLost("has disconnected");
    if (is_for_later(errno)) return 0;
    throw LinkLost("is lost: " + text_of_error(errno));
  }

  std::size_t write(std::span<const std::uint8_t> bytes) override {
    const ssize_t count = ::send(connection_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (is_for_later(errno)) return 0;
    throw LinkLost("does not accept the data that is sent to it: " + text_of_error(errno));
  }

  void hang_up() override { connection_ = Descriptor(); }

 private:
  Descriptor listener_;
  Descriptor connection_;
  std::string peer_;
};

class UdpLink final : public Link {
 public:
  UdpLink(const std::string& address, std::uint16_t port, const std::optional<sockaddr_in>& peer)
      : socket_(bind_socket(SOCK_DGRAM, address, port)), peer_(peer), is_fixed_(peer.has_value()) {}

  std::string place() const override { return place_of(socket_); }
  std::string peer() const override { return peer_ ? text_of(*peer_) : "nobody"; }
  bool is_connectionless() const override { return true; }
  int descriptor() const override { return socket_.number(); }
  bool connect() override { return true; }

  std::size_t read(std::span<std::uint8_t> bytes) override {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t count = ::recvfrom(socket_.number(), bytes.data(), bytes.size(), 0, generic(from), &size);
    // An earlier datagram had no receiver, which may appear later.
    if (count <= 0) return 0;
    if (peer_ && is_same(from, *peer_)) return static_cast<std::size_t>(count);
    // Two that speak at once would take turns otherwise.
    if (is_fixed_ || std::ranges::any_of(replaced_, [&](const auto& other) { return is_same(from, other); })) return 0;
    if (peer_) replaced_.push_back(*peer_);
    if (replaced_.size() > most_replaced) replaced_.erase(replaced_.begin());
    peer_ = from;
    return static_cast<std::size_t>(count);
  }

  std::size_t write(std::span<const std::uint8_t> bytes) override {
    if (!peer_) return bytes.size();  // no receiver
    const ssize_t count = ::sendto(socket_.number(), bytes.data(), bytes.size(), 0, generic(*peer_), sizeof *peer_);
    if (count < 0 && is_for_later(errno)) return 0;
    return bytes.size();  // datagrams without a receiver are lost
  }

  void hang_up() override {
    if (is_fixed_) return;
    peer_.reset();
    if (replaced_.empty()) return;
    peer_ = replaced_.back();
    replaced_.pop_back();
  }

 private:
  static constexpr std::size_t most_replaced = 16;

  Descriptor socket_;
  std::optional<sockaddr_in> peer_;
  bool is_fixed_;
  std::vector<sockaddr_in> replaced_;  // by one that spoke later, the last one at the end
};

}  // namespace

sockaddr_in endpoint_of(const std::string& address, std::uint16_t port) {
  sockaddr_in endpoint{};
  endpoint.sin_family = AF_INET;
  endpoint.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &endpoint.sin_addr) != 1)
    throw std::runtime_error("'" + address + "' is not an IPv4 address");
  return endpoint;
}

std::unique_ptr<Link> listen_for_tcp(const std::string& address, std::uint16_t port) {
  return std::make_unique<TcpLink>(address, port);
}

std::unique_ptr<Link> open_udp(const std::string& address, std::uint16_t port, const std::optional<sockaddr_in>& peer) {
  return std::make_unique<UdpLink>(address, port, peer);
}

}  // namespace cohort::bridges
