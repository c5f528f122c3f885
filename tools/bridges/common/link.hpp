// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

namespace cohort::bridges {

/// Thrown if the firmware has disconnected or cannot be reached any more. The text gives the reason to the user.
class LinkLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A connection to one robot's firmware that never blocks: TCP, UDP or a serial line. Not thread-safe.
class Link {
 public:
  virtual ~Link() = default;

  /// Returns the address or device to which the firmware connects, such as `127.0.0.1:1000` or `/dev/pts/3`.
  virtual std::string place() const = 0;

  /// Returns whether the link has no connections, like UDP and a pseudo-terminal. It then always counts as connected.
  virtual bool is_connectionless() const = 0;

  /// Accepts firmware that waits to be connected. Returns whether firmware is connected.
  virtual bool connect() = 0;

  /// Returns the name of the other side for messages to the user.
  virtual std::string peer() const = 0;

  /// Returns the file descriptor that is readable when firmware waits to be connected, or when bytes have arrived.
  virtual int descriptor() const = 0;

  /// Reads the bytes that have arrived, or as much of one datagram as fits, and returns how many; 0 if there are none.
  /// Throws LinkLost.
  virtual std::size_t read(std::span<std::uint8_t> bytes) = 0;

  /// Writes bytes and returns how many; 0 if none can be written now. A datagram is written whole. Throws LinkLost.
  virtual std::size_t write(std::span<const std::uint8_t> bytes) = 0;

  /// Ends the connection, so that other firmware can connect.
  virtual void hang_up() = 0;
};

/// Opens the link that `place` names. An address is an IPv4 address of this machine; the port 0 means any free port:
///
/// - `tcp:ADDRESS:PORT` waits for one connection at a time.
/// - `udp:ADDRESS:PORT` receives datagrams, and sends to the sender of the last one. A sender that another one has
///   replaced is ignored until the link is hung up.
/// - `udp:ADDRESS:PORT:PEER_ADDRESS:PEER_PORT` sends to the peer even before it has received anything, and ignores all
///   other senders.
/// - `serial:DEVICE:BAUD` opens a serial line, raw, 8 data bits, no parity, 1 stop bit. The device must exist at
///   first. If it is unplugged, it is opened again when it comes back.
/// - `pty` makes a pseudo-terminal, whose other end is a serial device to the firmware; `pty:PATH` also makes PATH a
///   symbolic link to it.
///
/// Throws std::runtime_error that says what cannot be opened and why, or what was expected.
std::unique_ptr<Link> open_link(const std::string& place);

}  // namespace cohort::bridges
