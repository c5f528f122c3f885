#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "idl/dds/identity.hpp"
#include "idl/dds/wire_error.hpp"

/// A thin RAII layer over the Cyclone DDS C API: the only code that includes it. Topic names and quality of service are
/// part of the protocol, so they belong to the message types (docs/protocol.md) and are not chosen by callers.
namespace cohort::wire {

enum class DdsLogKind {
  detail,   ///< for whoever looks for a fault
  refusal,  ///< a handshake of DDS Security failed; told once for each peer and reason, in words for people
  fatal,    ///< the process is about to be aborted
};

/// Receives what Cyclone DDS itself has to say, on any thread.
using DdsLogReceiver = void (*)(std::string_view message, DdsLogKind kind) noexcept;

/// From now on, for the whole process: Cyclone has one log. Without a receiver (or with nullptr) all but details go to
/// standard error, and these too if the environment's COHORT_LOG is `debug`.
void set_dds_log(DdsLogReceiver receiver);

/// The partition in which the server speaks to one client: `c` and the client's id as 16 hexadecimal digits.
std::string partition_of(std::uint64_t client);

/// The UDP port on which the server of a domain is found: 7410 + 250 * domain, and 2 further for each door.
std::uint16_t discovery_port(std::uint32_t domain, std::uint32_t door = 0);

struct ParticipantState;

/// One participant in one DDS domain. Discovery is a star: only the server has a known port, clients have it as their
/// only peer, nothing is multicast. A process may hold a server and any number of clients of the same domain; they meet
/// over the loopback as processes do. Must outlive its writers and readers.
class Participant {
 public:
  /// The server of `domain`, reachable on the interface that has `address` (an IPv4 address; loopback by default).
  /// Throws DomainTaken if another server has the domain, WireError for anything else. With `identity` (read_doors)
  /// it is one of the server's doors, under DDS Security: nobody but the client of that identity gets in.
  static Participant server(std::uint32_t domain, const std::string& address = "127.0.0.1",
                            const std::optional<Identity>& identity = {});
  /// A client of the server of `domain` at `address` (an IPv4 address or a host name); the interface that routes there
  /// is used. Does not wait for the server. With `identity` (read_identity) under DDS Security, to its door. Throws
  /// WireError.
  static Participant client(std::uint32_t domain, const std::string& address = "127.0.0.1",
                            const std::optional<Identity>& identity = {});

  Participant(Participant&&) noexcept;
  Participant& operator=(Participant&&) noexcept;
  ~Participant();

  /// None without security.
  const std::optional<Identity>& identity() const;

  ParticipantState& state() const { return *state_; }

 private:
  explicit Participant(std::unique_ptr<ParticipantState> state);
  std::unique_ptr<ParticipantState> state_;
};

}  // namespace cohort::wire
