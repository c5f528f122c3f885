// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/udp_floor.hpp"

#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace cohort::bench {
namespace {

// The header of each datagram, which is never smaller.
struct Head {
  std::uint64_t tick;
  std::uint32_t client;
  std::uint32_t bytes;  // size of the whole message; 0: a client's first message
};

constexpr std::size_t largest_datagram = 65'000;  // the limit of UDP is 65'507
constexpr int socket_buffer = 4 << 20;            // as for Cohort's DDS sockets
constexpr timeval patience{0, 100'000};           // time until a datagram that may be lost is sent again

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

void set_up(int descriptor) {
  setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &socket_buffer, sizeof socket_buffer);
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
}

// Each part contains its own header.
template <class Send>
void send_parts(std::vector<std::byte>& buffer, Head head, Send&& send) {
  for (std::size_t left = head.bytes; left > 0;) {
    const std::size_t part = std::min(left, largest_datagram);
    std::memcpy(buffer.data(), &head, sizeof head);
    send(buffer.data(), std::max(part, sizeof head));
    left -= part;
  }
}

}  // namespace

UdpSocket::UdpSocket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (descriptor_ < 0) fail("a UDP socket");
  set_up(descriptor_);
}

UdpSocket::~UdpSocket() { close(descriptor_); }

UdpFloor::UdpFloor(std::vector<std::size_t> observation_bytes, std::vector<std::size_t> command_bytes)
    : buffer_(largest_datagram) {
  const sockaddr_in any_port = loopback(0);
  if (bind(socket_.descriptor(), reinterpret_cast<const sockaddr*>(&any_port), sizeof any_port) != 0) fail("bind");
  sockaddr_in own{};
  socklen_t size = sizeof own;
  if (getsockname(socket_.descriptor(), reinterpret_cast<sockaddr*>(&own), &size) != 0) fail("getsockname");
  port_ = ntohs(own.sin_port);
  clients_.resize(observation_bytes.size());
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    clients_[i].observation_bytes = observation_bytes[i];
    clients_[i].command_bytes = command_bytes[i];
  }
}

bool UdpFloor::wait_for_clients(const std::atomic<bool>& broken, const std::atomic<bool>& stop) {
  for (std::size_t missing = clients_.size(); missing > 0;) {
    if (broken || stop) return false;
    Head head{};
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t bytes =
        recvfrom(socket_.descriptor(), &head, sizeof head, MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes < static_cast<ssize_t>(sizeof head) || head.client >= clients_.size()) continue;
    Client& client = clients_[head.client];
    if (!client.has_called) --missing;
    client.has_called = true;
    client.address = from;
  }
  return true;
}

void UdpFloor::send_frame(const Client& client) {
  const auto number = static_cast<std::uint32_t>(&client - clients_.data());
  send_parts(buffer_, {tick_, number, static_cast<std::uint32_t>(client.observation_bytes)},
             [&](const std::byte* data, std::size_t bytes) {
               sendto(socket_.descriptor(), data, bytes, 0, reinterpret_cast<const sockaddr*>(&client.address),
                      sizeof client.address);
             });
}

bool UdpFloor::exchange(const std::atomic<bool>& broken, const std::atomic<bool>& stop) {
  ++tick_;
  for (Client& client : clients_) {
    client.received = 0;
    send_frame(client);
  }
  for (std::size_t missing = clients_.size(); missing > 0;) {
    const ssize_t bytes = recv(socket_.descriptor(), buffer_.data(), buffer_.size(), 0);
    if (bytes < static_cast<ssize_t>(sizeof(Head))) {
      if (broken || stop) return false;
      for (Client& client : clients_) {
        if (client.received >= client.command_bytes) continue;
        client.received = 0;
        send_frame(client);
      }
      continue;
    }
    Head head{};
    std::memcpy(&head, buffer_.data(), sizeof head);
    if (head.tick != tick_ || head.client >= clients_.size() || head.bytes == 0) continue;
    Client& client = clients_[head.client];
    if (client.received >= client.command_bytes) continue;
    client.received += static_cast<std::size_t>(bytes);
    if (client.received >= client.command_bytes) --missing;
  }
  return true;
}

void run_udp_client(const UdpClientOptions& options, const std::atomic<bool>& stop) {
  const UdpSocket own;
  const sockaddr_in server = loopback(options.port);
  if (connect(own.descriptor(), reinterpret_cast<const sockaddr*>(&server), sizeof server) != 0) fail("connect");
  std::vector<std::byte> buffer(largest_datagram);
  std::uint64_t tick = 0;
  std::size_t received = 0;
  const auto call = [&] {
    const Head head{0, options.number, 0};
    send(own.descriptor(), &head, sizeof head, 0);
  };
  call();
  while (!stop) {
    const ssize_t bytes = recv(own.descriptor(), buffer.data(), buffer.size(), 0);
    if (bytes < static_cast<ssize_t>(sizeof(Head))) {
      if (tick == 0 && !stop) call();
      continue;
    }
    Head head{};
    std::memcpy(&head, buffer.data(), sizeof head);
    // A complete tick is sent again because its answer, or a part of the frame, was lost.
    if (head.tick != tick || received >= head.bytes) received = 0;
    tick = head.tick;
    received += static_cast<std::size_t>(bytes);
    if (received < head.bytes) continue;
    send_parts(buffer, {tick, options.number, static_cast<std::uint32_t>(options.command_bytes)},
               [&](const std::byte* data, std::size_t part) { send(own.descriptor(), data, part, 0); });
  }
}

}  // namespace cohort::bench
