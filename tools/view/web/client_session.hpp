// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/view/messages/topics.hpp"
#include "tools/view/source.hpp"
#include "tools/view/web/protocol.hpp"

namespace cohort::view {

/// One client of the Foxglove WebSocket protocol, without its socket: handles the client's messages, and provides the
/// next message to send. A client that reads slowly misses messages: only the latest message of each topic waits for
/// it, and at most `most_replies` answers, of which `most_histories` are histories. Not thread-safe.
class ClientSession {
 public:
  static constexpr std::size_t most_subscriptions = 64;
  static constexpr std::size_t most_replies = 64;
  static constexpr std::size_t most_watched = 256;
  /// Limit of histories among the waiting replies, because they are large.
  static constexpr std::size_t most_histories = 4;

  struct Text {
    std::string text;
  };
  struct Data {
    std::array<std::byte, 13> head;
    std::shared_ptr<const Published> published;
  };
  using Outgoing = std::variant<Text, recording::Bytes, Data>;

  struct Callbacks {
    /// Handles a request of the client, which is answered by `respond`.
    std::function<void(const protocol::ServiceCall&, const ViewRequest&)> ask;
    std::function<void()> watched_changed;
  };
  ClientSession(Topics& topics, const std::string& name, const std::string& session, Callbacks callbacks);
  ~ClientSession();

  /// Handle a message of the client. Invalid messages are answered with a status.
  void take_text(std::string_view text);
  void take_binary(std::span<const std::byte> bytes);
  void respond(const protocol::ServiceCall& call, const Answer& answer);

  /// Returns the next message to send; nullopt if there is nothing new.
  std::optional<Outgoing> next();
  /// Returns the ids of the robots whose channels the client has requested.
  const std::vector<std::uint32_t>& watched() const { return watched_; }

 private:
  struct Slot {
    std::uint32_t channel = 0;
    std::uint64_t sent = 0;  // version of the message that was sent last
  };
  void take(const protocol::Subscribe& subscribe);
  void take(const protocol::Unsubscribe& unsubscribe);
  void take(const protocol::ServiceCall& call);
  void take(const protocol::NotOffered& refused);
  void reply(Outgoing outgoing);
  void complain(const std::string& text);
  void watch(const protocol::ServiceCall& call, const ViewRequest& request);
  std::optional<Outgoing> next_of(std::map<std::uint32_t, Slot>::iterator begin,
                                  std::map<std::uint32_t, Slot>::iterator end);

  Topics& topics_;
  Callbacks callbacks_;
  std::deque<Outgoing> replies_;
  std::size_t histories_ = 0;                    // in replies_ since these were last empty
  std::map<std::uint32_t, Slot> subscriptions_;  // by the client's subscription ids
  std::uint32_t last_served_ = 0;
  std::vector<std::uint32_t> watched_;
};

}  // namespace cohort::view
