// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "idl/dds/identity.hpp"
#include "idl/dds/wire_error.hpp"

/// A thin RAII layer over the C API of Cyclone DDS, and the only code that includes it. Topic names and quality of
/// service are part of the protocol, so they belong to the message types (docs/protocol.md), and callers do not choose
/// them.
namespace cohort::wire {

enum class DdsLogKind {
  detail,   ///< for debugging
  refusal,  ///< a failed handshake of DDS Security; reported once for each peer and reason
  fatal,    ///< the process is about to abort
};

/// Receives the log messages of Cyclone DDS, on any thread.
using DdsLogReceiver = void (*)(std::string_view message, DdsLogKind kind) noexcept;

/// Sets the receiver for the whole process, because Cyclone has one log. Without a receiver (or with nullptr), all
/// messages except details go to standard error. Details also go there if the environment variable COHORT_LOG is
/// `debug`.
void set_dds_log(DdsLogReceiver receiver);

/// Returns the partition for the server's messages to one client: `c` and the client's id as 16 hexadecimal digits.
std::string partition_of(std::uint64_t client);

/// Returns the UDP port at which the server of a domain is found: 7410 + 250 * domain + 2 * participant.
std::uint16_t discovery_port(std::uint32_t domain, std::uint32_t participant = 0);

struct ParticipantState;

/// One participant in one DDS domain. Discovery is a star: only the server has a known port, which is the only peer of
/// its clients, and nothing is multicast. A process may contain a server and any number of clients of the same domain;
/// they communicate over the loopback like processes. Must outlive its writers and readers.
class Participant {
 public:
  /// Creates the server of `domain`, reachable on the interface with `address` (an IPv4 address; loopback by default).
  /// Throws DomainTaken if another server uses the domain, WireError for other errors. With `identity`
  /// (read_server_identities) it is one of the server's participants under DDS Security, which admits only the client
  /// with that identity.
  static Participant server(std::uint32_t domain, const std::string& address = "127.0.0.1",
                            const std::optional<Identity>& identity = {});
  /// Creates a client of the server of `domain` at `address` (an IPv4 address or a host name). Uses the interface that
  /// routes there. Does not wait for the server. With `identity` (read_identity) it connects to
  /// the server's participant for that identity, under DDS Security. Throws WireError.
  static Participant client(std::uint32_t domain, const std::string& address = "127.0.0.1",
                            const std::optional<Identity>& identity = {});

  Participant(Participant&&) noexcept;
  Participant& operator=(Participant&&) noexcept;
  ~Participant();

  /// Returns the identity; none without security.
  const std::optional<Identity>& identity() const;

  ParticipantState& state() const { return *state_; }

 private:
  explicit Participant(std::unique_ptr<ParticipantState> state);
  std::unique_ptr<ParticipantState> state_;
};

}  // namespace cohort::wire
