#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "idl/dds/identity.hpp"
#include "idl/wire/control_messages.hpp"
#include "idl/wire/messages.hpp"

/// A thin RAII layer over the Cyclone DDS C API: the only code that includes it. Topic names and quality of service are
/// part of the protocol, so they belong to the message types (docs/protocol.md) and are not chosen by callers.
namespace cohort::wire {

/// DDS refused: the message says what was tried and what to do about it.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The port of the server's domain is taken by another process.
class DomainTaken : public WireError {
 public:
  using WireError::WireError;
};

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

  struct State;
  State& state() const { return *state_; }

 private:
  explicit Participant(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes messages of one type. Not copyable. `write` may be called from any one thread at a time, and never from
/// inside a reader's callback unless the message's quality of service is KEEP_LAST (all of ours are).
template <class Message>
class Writer {
 public:
  /// `partition`: empty for the default one. `depth`: frames kept for readers that are behind (KEEP_LAST); for
  /// Observation and Command, the depth of the other messages is fixed. Throws WireError.
  explicit Writer(Participant& participant, const std::string& partition = "", int depth = 1);
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// False if DDS could not take the message in time (100 ms): the message counts as lost. Throws WireError otherwise.
  bool write(const Message& message);
  /// Waits until every matched reader has all that was written; false if that took too long.
  bool wait_until_received(std::chrono::milliseconds at_most);
  /// Readers matched now.
  std::uint32_t matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What came with a message.
struct Sender {
  std::uint64_t writer = 0;       ///< identifies the DDS writer within this process
  std::uint64_t participant = 0;  ///< identifies its participant likewise: DDS says it, the sender cannot choose it
};

/// Reads messages of one type. All callbacks run on a thread of DDS, one at a time for each reader and perhaps before
/// the constructor returns: they must not throw, block for long, or create or destroy entities. Set at construction, so
/// nothing is missed; the destructor waits until none runs, so it must not be called with a lock that a callback takes.
template <class Message>
class Reader {
 public:
  struct Callbacks {
    std::function<void(const Message&, const Sender&)> message;
    /// A writer of this topic appeared, or was found dead (lease over, unmatched) or alive again; may repeat. May be
    /// empty.
    std::function<void(const Sender&, bool alive)> liveliness;
  };
  Reader(Participant& participant, Callbacks callbacks, const std::string& partition = "", int depth = 1);
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;
  ~Reader();

  /// Writers matched now.
  std::uint32_t matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class Writer<Join>;
extern template class Writer<Admit>;
extern template class Writer<RobotDescription>;
extern template class Writer<Observation>;
extern template class Writer<Command>;
extern template class Writer<WorldState>;
extern template class Writer<SceneDescription>;
extern template class Writer<SceneUpdate>;
extern template class Writer<Report>;
extern template class Writer<ControllerState>;
extern template class Writer<Request>;
extern template class Writer<Reply>;
extern template class Reader<Join>;
extern template class Reader<Admit>;
extern template class Reader<RobotDescription>;
extern template class Reader<Observation>;
extern template class Reader<Command>;
extern template class Reader<WorldState>;
extern template class Reader<SceneDescription>;
extern template class Reader<SceneUpdate>;
extern template class Reader<Report>;
extern template class Reader<ControllerState>;
extern template class Reader<Request>;
extern template class Reader<Reply>;

}  // namespace cohort::wire
