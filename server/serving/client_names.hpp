// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "idl/dds/transport.hpp"

namespace cohort::session {

/// The id and the source of each joined client, so that no client can use another's id or occupy all slots. Only the
/// participant and the identity from DDS count, not the client's own claims. Pure logic. Not thread-safe: use it under
/// the server's lock.
class ClientNames {
 public:
  // The server has three writers for each client; DDS cannot create more of them at about 10,000 clients.
  static constexpr std::size_t most_clients = 2048;
  static constexpr std::size_t most_of_one_identity = 1024;

  /// Registers a Join under this id from `sender`, which has authenticated as `identity` if security is enabled.
  /// Returns an empty text if the client may be attached; otherwise the reason, which starts with a keyword of
  /// docs/protocol.md. A participant has at most one client that is not gone.
  std::string enter(std::uint64_t client, const wire::Sender& sender,
                    const std::optional<wire::Identity>& identity = {});
  /// Notes that the writer of the client's last Join has disappeared or reappeared. The id stays until it is forgotten.
  void set_gone(std::uint64_t client, bool gone) {
    if (const auto found = names_.find(client); found != names_.end()) found->second.gone = gone;
  }
  void forget(std::uint64_t client);

  /// Returns the client whose last Join came from this writer, if any.
  std::optional<std::uint64_t> client_of_writer(std::uint64_t writer) const;
  /// Returns true if the sample comes from the process that joined under this id.
  bool is_in_own_name(std::uint64_t client, const wire::Sender& sender) const;

 private:
  struct Name {
    std::uint64_t participant;
    std::uint64_t writer;
    std::string identity;
    bool gone;
  };
  std::map<std::uint64_t, Name> names_;                           // by client
  std::map<std::uint64_t, std::uint64_t> client_of_participant_;  // the last client id of each participant
  std::map<std::uint64_t, std::uint64_t> client_of_writer_;       // by the writer of the last Join
  std::map<std::string, std::size_t> clients_of_identity_;
};

}  // namespace cohort::session
