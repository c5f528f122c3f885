#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

namespace cohort::bridges {

/// The firmware has left, or cannot be reached any more: why, for people.
class LinkLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A connection to one robot's firmware that never blocks: TCP, UDP or a serial line. One thread at a time.
class Link {
 public:
  virtual ~Link() = default;

  /// Returns where the firmware reaches it, such as `127.0.0.1:1000` or `/dev/pts/3`.
  virtual std::string place() const = 0;

  /// Returns whether it has no connections, as a pseudo-terminal and UDP: then it is connected always.
  virtual bool is_connectionless() const = 0;

  /// Returns whether firmware is connected, and connects firmware that waits to be.
  virtual bool connect() = 0;

  /// Returns who is connected, for people.
  virtual std::string peer() const = 0;

  /// Returns the file descriptor that is readable when firmware waits to be connected, or when bytes are there.
  virtual int descriptor() const = 0;

  /// Reads bytes that are there, of a datagram all that fit, and returns how many; 0 if there are none. Throws
  /// LinkLost.
  virtual std::size_t read(std::span<std::uint8_t> bytes) = 0;

  /// Writes bytes and returns how many; 0 if none can be taken now. A datagram is written whole. Throws LinkLost.
  virtual std::size_t write(std::span<const std::uint8_t> bytes) = 0;

  /// Ends the connection, so that other firmware can connect.
  virtual void hang_up() = 0;
};

/// Opens the link that `place` names; an address is an IPv4 address of this machine, a port of 0 is any free one:
///
/// - `tcp:ADDRESS:PORT` waits for one connection at a time.
/// - `udp:ADDRESS:PORT` takes datagrams, and answers to where the last one came from. One that another sender has
///   replaced is not heard any more, unless the other is hung up.
/// - `udp:ADDRESS:PORT:PEER_ADDRESS:PEER_PORT` also sends there before any came, and takes none from elsewhere.
/// - `serial:DEVICE:BAUD` opens a serial line, raw, 8 data bits, no parity, 1 stop bit. Its device is there at first,
/// and
///   is opened again when it was unplugged and has come back.
/// - `pty` makes a pseudo-terminal, whose other end is a serial device to the firmware; `pty:PATH` also makes PATH a
///   symbolic link to it.
///
/// Throws std::runtime_error that says what cannot be opened and why, or what was expected.
std::unique_ptr<Link> open_link(const std::string& place);

}  // namespace cohort::bridges
