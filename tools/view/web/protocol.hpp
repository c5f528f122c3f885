// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/recording/mcap/format/mcap.hpp"
#include "tools/view/messages/topics.hpp"

/// Messages of the Foxglove WebSocket protocol, version 1:
/// https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
namespace cohort::view::protocol {

inline constexpr const char* subprotocol = "foxglove.websocket.v1";

/// Thrown if a client's message does not conform to the protocol. The text is for the author of the client.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Subscription {
  std::uint32_t id = 0;  ///< chosen by the client
  std::uint32_t channel = 0;
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
struct ServiceCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
  std::string encoding;
  std::string payload;
};
/// An operation of the protocol that is not offered.
struct NotOffered {
  std::string operation;
};
using FromClient = std::variant<Subscribe, Unsubscribe, ServiceCall, NotOffered>;

/// Parse a message of a client. Throw ProtocolError.
FromClient parse_text(std::string_view text);
FromClient parse_binary(std::span<const std::byte> bytes);

inline constexpr std::uint32_t control_service = 1;

enum class StatusLevel { info = 0, warning = 1, error = 2 };

/// Return text messages to a client.
std::string server_info(const std::string& name, const std::string& session);
std::string advertise_channels();
std::string advertise_services();
std::string status(StatusLevel level, const std::string& message);
std::string service_failure(const ServiceCall& call, const std::string& message);

/// Return binary messages to a client. A message's data follow its head.
std::array<std::byte, 13> message_head(std::uint32_t subscription, std::chrono::nanoseconds time);
recording::Bytes service_response(const ServiceCall& call, const std::string& payload);

}  // namespace cohort::view::protocol
