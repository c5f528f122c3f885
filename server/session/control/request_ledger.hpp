#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "idl/control_messages.hpp"

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

  /// Data that the client fetches in parts; what it had before is gone. Of the clients that have some, the two last
  /// ones keep it.
  void offer(std::uint64_t client, std::shared_ptr<const std::vector<std::byte>> data);
  /// The part from `offset` on, empty after the end; nothing if there is no data for the client.
  struct Part {
    std::uint64_t size = 0;  ///< of all
    std::span<const std::byte> bytes{};
  };
  std::optional<Part> part(std::uint64_t client, std::uint64_t offset) const;

  /// A part of what the client hands over: from offset 0 on, one after the other; again is no mistake. A sentence that
  /// says what is wrong, or nothing.
  std::optional<std::string> take_part(std::uint64_t client, std::uint64_t size, std::uint64_t offset,
                                       std::span<const std::uint8_t> bytes);
  /// All that it has handed over; nothing if it is not complete. It is gone from here.
  std::optional<std::vector<std::byte>> take_all(std::uint64_t client);

  /// The client is gone: its data goes; its replies stay, in case it is found again.
  void leave(std::uint64_t client);

 private:
  static constexpr std::size_t most_clients = 256;
  static constexpr std::size_t most_holders = 2;  // of data, each way
  struct Client {
    std::uint64_t who = 0;
    std::uint64_t newest = 0;
    std::map<std::uint64_t, std::optional<wire::Reply>> replies{};  // by number; none: under way
    std::uint64_t used = 0;                                         // when
  };
  struct Incoming {
    std::uint64_t size = 0;
    std::vector<std::byte> bytes{};
  };
  template <class Data>
  using Holders = std::list<std::pair<std::uint64_t, Data>>;  // by client, the last to come at the end
  template <class Data>
  static auto find(Data& holders, std::uint64_t client);
  template <class Data>
  static Data& renew(Holders<Data>& holders, std::uint64_t client);

  std::map<std::uint64_t, Client> clients_;
  std::map<std::uint64_t, std::uint64_t> client_of_;  // by participant
  std::uint64_t uses_ = 0;
  std::deque<wire::Request> waiting_;
  Holders<std::shared_ptr<const std::vector<std::byte>>> outgoing_;
  Holders<Incoming> incoming_;
};

}  // namespace cohort::session
