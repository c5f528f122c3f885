// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <string>

#include "tools/bridges/common/descriptor.hpp"
#include "tools/bridges/common/link.hpp"

namespace cohort::betaflight {

/// The datagrams of one program. It sends from any port, and listens on two: the contents of a packet determine its
/// port.
class ProgramLink final : public bridges::Link {
 public:
  /// `socket` is non-blocking and bound to the port of servo packets. `address` is the program's IPv4 address.
  ProgramLink(bridges::Descriptor socket, const std::string& address);

  std::string place() const override;
  std::string peer() const override;
  bool is_connectionless() const override { return true; }
  bool connect() override { return true; }
  int descriptor() const override { return socket_.number(); }
  std::size_t read(std::span<std::uint8_t> bytes) override;
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  void hang_up() override {}

 private:
  bridges::Descriptor socket_;
  sockaddr_in program_;
  int mistakes_ = 0;
};

/// Returns whether the program at this IPv4 address has booted and accepts state packets. The program opens its command
/// line last, so it has booted if it accepts a connection there. Also returns true if there is no answer within 100 ms,
/// such as behind a firewall, because the state is then unknown.
bool has_booted(const std::string& address);

/// Returns a socket for servo packets, bound to this address of the machine. Throws std::runtime_error.
bridges::Descriptor open_servo_socket(const std::string& address);

}  // namespace cohort::betaflight
