// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "idl/wire/control_messages.hpp"
#include "server/serving/control/requests/kept_for_client.hpp"

namespace cohort::session {

/// The requests of the clients that control a session, their replies, so that no request is carried out twice, and data
/// that is transferred in parts. All of it is bounded. Pure logic, no network. Not thread-safe.
class RequestLedger {
 public:
  /// Returns true if the first request with this client id came from the participant `who`. A participant has only one
  /// id.
  bool is_in_own_name(std::uint64_t client, std::uint64_t who);

  enum class Receipt {
    fresh,      ///< to be carried out; `keep` ends it
    under_way,  ///< in progress, or waiting to be carried out
    answered,   ///< `remembered` is its reply
    forgotten,  ///< older than the remembered replies
    too_many,   ///< the client has reached its limit of requests in progress
  };
  /// Registers a request that changes something. A fresh one is in progress from now on.
  Receipt receive(std::uint64_t client, std::uint64_t number);
  const wire::Reply& remembered(std::uint64_t client, std::uint64_t number) const;
  /// Stores the reply of a completed request.
  void keep(const wire::Reply& reply);

  /// Returns the requests that wait for a boundary, in order of arrival.
  std::deque<wire::Request>& waiting() { return waiting_; }
  const std::deque<wire::Request>& waiting() const { return waiting_; }

  /// Offers data that the client fetches in parts, in place of earlier data.
  void offer(std::uint64_t client, std::shared_ptr<const std::vector<std::byte>> data, KeptForClient::Time now);
  struct Part {
    std::uint64_t size = 0;  ///< size of the whole data
    std::span<const std::byte> bytes{};
  };
  /// Returns the part from `offset` on, empty after the end; nothing if there is no data for the client.
  std::optional<Part> part(std::uint64_t client, std::uint64_t offset) const;

  /// Takes a part of an upload. Parts arrive in order from offset 0 on; repeated parts are allowed. Returns the fault,
  /// or nothing.
  std::optional<std::string> take_part(std::uint64_t client, std::uint64_t size, std::uint64_t offset,
                                       std::span<const std::uint8_t> bytes, KeptForClient::Time now);
  /// Removes and returns the client's upload; nothing if it is not complete.
  std::optional<std::vector<std::byte>> take_all(std::uint64_t client);

  /// Adds the data that is kept for clients. Data that several clients fetch is counted once, for the last of them.
  void list(std::vector<KeptForClient>& kept) const;
  /// Forgets data of a client, which learns the reason when it asks for it.
  void drop(const KeptForClient& kept, const std::string& why);
  /// Returns why data of this client was dropped; empty if none was.
  std::string why_dropped(std::uint64_t client, KeptForClient::Kind kind) const;

  /// Removes the data of a client that has left. Its replies stay, in case it returns.
  void leave(std::uint64_t client);

 private:
  static constexpr std::size_t most_clients = 256;
  struct Client {
    std::uint64_t who = 0;
    std::uint64_t newest = 0;
    std::map<std::uint64_t, std::optional<wire::Reply>> replies{};  // by number; without a value: in progress
    std::uint64_t used = 0;                                         // when it was last used
  };
  struct Outgoing {
    KeptForClient::Time since{0};
    std::shared_ptr<const std::vector<std::byte>> bytes{};
  };
  struct Incoming {
    KeptForClient::Time since{0};
    std::uint64_t size = 0;
    std::vector<std::byte> bytes{};
  };

  std::map<std::uint64_t, Client> clients_;
  std::map<std::uint64_t, std::uint64_t> client_of_;  // by participant
  std::uint64_t uses_ = 0;
  std::deque<wire::Request> waiting_;
  std::map<std::uint64_t, Outgoing> outgoing_;  // by client, like the next member
  std::map<std::uint64_t, Incoming> incoming_;
  std::map<std::pair<std::uint64_t, KeptForClient::Kind>, std::string> dropped_;  // reason
};

}  // namespace cohort::session
