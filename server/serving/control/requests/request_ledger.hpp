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

/// The memory of those who control a session: which request was answered how, so that none is done twice, what waits to
/// be done, and data on its way in parts. All of it is bounded. Pure logic, no network. Not thread-safe.
class RequestLedger {
 public:
  /// Whether the client of this id is who it was when its first request came; `who` identifies the participant.
  /// A participant has one id.
  bool is_in_own_name(std::uint64_t client, std::uint64_t who);

  enum class Receipt {
    fresh,      ///< to be done; `keep` ends it
    under_way,  ///< it is being done, or waits for it
    answered,   ///< `remembered` is its reply
    forgotten,  ///< older than what is remembered
    too_many,   ///< the client has as many under way as it may
  };
  /// An operation that changes something has come. A fresh one is under way from now on.
  Receipt receive(std::uint64_t client, std::uint64_t number);
  const wire::Reply& remembered(std::uint64_t client, std::uint64_t number) const;
  /// The operation is done.
  void keep(const wire::Reply& reply);

  /// What waits for a boundary, in the order of arrival.
  std::deque<wire::Request>& waiting() { return waiting_; }
  const std::deque<wire::Request>& waiting() const { return waiting_; }

  /// Data that the client fetches in parts; what it had before is gone.
  void offer(std::uint64_t client, std::shared_ptr<const std::vector<std::byte>> data, KeptForClient::Time now);
  /// The part from `offset` on, empty after the end; nothing if there is no data for the client.
  struct Part {
    std::uint64_t size = 0;  ///< of all
    std::span<const std::byte> bytes{};
  };
  std::optional<Part> part(std::uint64_t client, std::uint64_t offset) const;

  /// A part of what the client hands over: from offset 0 on, one after the other; again is no mistake. A sentence that
  /// says what is wrong, or nothing.
  std::optional<std::string> take_part(std::uint64_t client, std::uint64_t size, std::uint64_t offset,
                                       std::span<const std::uint8_t> bytes, KeptForClient::Time now);
  /// All that it has handed over; nothing if it is not complete. It is gone from here.
  std::optional<std::vector<std::byte>> take_all(std::uint64_t client);

  /// Adds what is kept for clients. Data that several fetch is counted once, for the last of them.
  void list(std::vector<KeptForClient>& kept) const;
  /// Forgets data of a client: those who ask for it are told why.
  void drop(const KeptForClient& kept, const std::string& why);
  /// Why data of this client was dropped; empty if none was.
  std::string why_dropped(std::uint64_t client, KeptForClient::Kind kind) const;

  /// The client is gone: its data goes; its replies stay, in case it is found again.
  void leave(std::uint64_t client);

 private:
  static constexpr std::size_t most_clients = 256;
  struct Client {
    std::uint64_t who = 0;
    std::uint64_t newest = 0;
    std::map<std::uint64_t, std::optional<wire::Reply>> replies{};  // by number; none: under way
    std::uint64_t used = 0;                                         // when
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
  std::map<std::uint64_t, Outgoing> outgoing_;  // by client, like the next
  std::map<std::uint64_t, Incoming> incoming_;
  std::map<std::pair<std::uint64_t, KeptForClient::Kind>, std::string> dropped_;  // why
};

}  // namespace cohort::session
