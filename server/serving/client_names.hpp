#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "idl/dds/transport.hpp"

namespace cohort::session {

/// Under which id each client has joined, and from where, so that nobody speaks in another's name and no stranger takes
/// all the room. What a client says of itself counts for nothing: its participant and its identity are DDS's. Pure
/// logic. Not thread-safe: under the server's lock.
class ClientNames {
 public:
  // Each has three writers here, with their topics; DDS makes none any more before there are 10,000 clients.
  static constexpr std::size_t most_clients = 2048;
  static constexpr std::size_t most_of_one_identity = 1024;

  /// A Join under this id, from `sender`, which has authenticated as `identity` if there is security. Empty if it may
  /// be attached, and then it is entered; otherwise why not, beginning with a word of docs/protocol.md. A participant
  /// has one client at a time that is not gone.
  std::string enter(std::uint64_t client, const wire::Sender& sender,
                    const std::optional<wire::Identity>& identity = {});
  /// Its last Join's writer is gone, or is back: its id stays until it is forgotten.
  void set_gone(std::uint64_t client, bool gone) {
    if (const auto found = names_.find(client); found != names_.end()) found->second.gone = gone;
  }
  void forget(std::uint64_t client);

  /// Whose last Join came from this writer, if anybody's.
  std::optional<std::uint64_t> client_of_writer(std::uint64_t writer) const;
  /// Whether it comes from the process that joined under that id.
  bool is_in_own_name(std::uint64_t client, const wire::Sender& sender) const;

 private:
  struct Name {
    std::uint64_t participant;
    std::uint64_t writer;
    std::string identity;
    bool gone;
  };
  std::map<std::uint64_t, Name> names_;                           // by client
  std::map<std::uint64_t, std::uint64_t> client_of_participant_;  // the last that it joined under
  std::map<std::uint64_t, std::uint64_t> client_of_writer_;       // of last Joins
  std::map<std::string, std::size_t> clients_of_identity_;
};

}  // namespace cohort::session
