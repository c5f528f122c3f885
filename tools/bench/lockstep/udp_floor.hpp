#pragma once

#include <netinet/in.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

/// The same exchange without DDS: a server sends each client a datagram a tick, each answers at once with another. What
/// does not fit into one datagram goes in several. Sizes are those of the messages; their content is not looked at but
/// for a few bytes at the front.
namespace cohort::bench {

class UdpSocket {
 public:
  /// Throws std::system_error.
  UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// The server's side, on a port of its own of the loopback.
class UdpFloor {
 public:
  /// `observation_bytes` and `command_bytes` by client.
  UdpFloor(std::vector<std::size_t> observation_bytes, std::vector<std::size_t> command_bytes);

  std::uint16_t port() const { return port_; }
  /// Waits until every client has called; false if one of these was set before.
  bool wait_for_clients(const std::atomic<bool>& broken, const std::atomic<bool>& stop);
  /// One tick: everything sent, every answer received. What is lost is sent again after a while. False if one of these
  /// was set meanwhile.
  bool exchange(const std::atomic<bool>& broken, const std::atomic<bool>& stop);

 private:
  struct Client {
    std::size_t observation_bytes = 0;
    std::size_t command_bytes = 0;
    std::size_t received = 0;  // of this tick's answer
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
  std::uint32_t number = 0;  ///< of this client
  std::size_t command_bytes = 0;
};
/// A client's side, until `stop` is set (a signal that sets it ends a wait).
void run_udp_client(const UdpClientOptions& options, const std::atomic<bool>& stop);

}  // namespace cohort::bench
