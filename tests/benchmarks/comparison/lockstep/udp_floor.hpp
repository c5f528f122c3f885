// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

/// The same exchange without DDS, as a lower bound. In each tick, a server sends each client a datagram, and each
/// client answers immediately. Larger messages are split into several datagrams. Sizes are those of the messages; only
/// a few bytes at the front are read.
namespace cohort::bench {

class UdpSocket {
 public:
  /// Opens a socket. Throws std::system_error.
  UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// The server's side, on a separate port of the loopback interface.
class UdpFloor {
 public:
  /// `observation_bytes` and `command_bytes` are sizes for each client.
  UdpFloor(std::vector<std::size_t> observation_bytes, std::vector<std::size_t> command_bytes);

  std::uint16_t port() const { return port_; }
  /// Waits until every client has sent its first message. Returns false if `broken` or `stop` is set before.
  bool wait_for_clients(const std::atomic<bool>& broken, const std::atomic<bool>& stop);
  /// Executes one tick: sends all datagrams and receives all answers. Sends lost datagrams again after a timeout.
  /// Returns false if `broken` or `stop` is set meanwhile.
  bool exchange(const std::atomic<bool>& broken, const std::atomic<bool>& stop);

 private:
  struct Client {
    std::size_t observation_bytes = 0;
    std::size_t command_bytes = 0;
    std::size_t received = 0;  // received bytes of this tick's answer
    sockaddr_in address{};
    bool has_called = false;
  };
  void send_frame(const Client& client);

  UdpSocket socket_;
  std::uint16_t port_ = 0;
  std::vector<Client> clients_;
  std::vector<std::byte> buffer_;
  std::uint64_t tick_ = 0;
};

struct UdpClientOptions {
  std::uint16_t port = 0;
  std::uint32_t number = 0;  ///< number of this client
  std::size_t command_bytes = 0;
};
/// Runs a client's side until `stop` is set (a signal that sets it ends a wait).
void run_udp_client(const UdpClientOptions& options, const std::atomic<bool>& stop);

}  // namespace cohort::bench
