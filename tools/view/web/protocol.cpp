// SPDX-License-Identifier: Apache-2.0
#include "tools/view/web/protocol.hpp"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "idl/text/printable.hpp"

namespace cohort::view::protocol {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little);

enum class FromServer : std::uint8_t { message_data = 1, service_response = 3 };
enum class ClientOpcode : std::uint8_t { message_data = 1, service_request = 2 };

// A client may ask for that many at once.
constexpr std::size_t most_subscriptions = 256;

template <class Number>
void append(recording::Bytes& to, Number number) {
  const auto bytes = std::bit_cast<std::array<std::byte, sizeof(Number)>>(number);
  to.insert(to.end(), bytes.begin(), bytes.end());
}

// Names and texts may contain any bytes.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

void append_text(recording::Bytes& to, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

std::uint32_t number_of(const Json& json, const char* what) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > 0xffffffffu)
    throw ProtocolError(std::string(what) + " is not a number from 0 to 4294967295");
  return json.get<std::uint32_t>();
}

const Json& list_of(const Json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end() || !found->is_array()) throw ProtocolError(std::string(name) + " is not a list");
  if (found->size() > most_subscriptions) throw ProtocolError(std::string(name) + " is too long");
  return *found;
}

Subscribe read_subscribe(const Json& message) {
  Subscribe subscribe;
  const Json& list = list_of(message, "subscriptions");
  subscribe.subscriptions.reserve(list.size());
  for (const Json& each : list) {
    if (!each.is_object() || !each.contains("id") || !each.contains("channelId"))
      throw ProtocolError("a subscription needs id and channelId");
    subscribe.subscriptions.push_back({number_of(each["id"], "id"), number_of(each["channelId"], "channelId")});
  }
  return subscribe;
}

Unsubscribe read_unsubscribe(const Json& message) {
  Unsubscribe unsubscribe;
  const Json& list = list_of(message, "subscriptionIds");
  unsubscribe.ids.reserve(list.size());
  for (const Json& each : list) unsubscribe.ids.push_back(number_of(each, "a subscription's id"));
  return unsubscribe;
}

class BytesReader {
 public:
  explicit BytesReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::uint32_t number() {
    std::array<std::byte, 4> bytes{};
    std::ranges::copy(take(bytes.size()), bytes.begin());
    return std::bit_cast<std::uint32_t>(bytes);
  }
  std::string text(std::size_t size) {
    const auto bytes = take(size);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::string rest() { return text(bytes_.size()); }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (size > bytes_.size()) throw ProtocolError("a binary message is truncated");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  std::span<const std::byte> bytes_;
};

Json schema_of_json(const char* name) {
  return {{"encoding", "json"},
          {"schemaName", name},
          {"schemaEncoding", "jsonschema"},
          {"schema", R"({"type": "object"})"}};
}

}  // namespace

FromClient parse_text(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object() || !message.contains("op") || !message["op"].is_string())
    throw ProtocolError("a text message must be a JSON object with op");
  const auto operation = message["op"].get<std::string>();
  if (operation == "subscribe") return read_subscribe(message);
  if (operation == "unsubscribe") return read_unsubscribe(message);
  constexpr std::size_t longest_name = 40;
  return NotOffered{printable(operation, longest_name)};
}

FromClient parse_binary(std::span<const std::byte> bytes) {
  if (bytes.empty()) throw ProtocolError("a binary message is empty");
  const auto opcode = static_cast<ClientOpcode>(bytes.front());
  if (opcode == ClientOpcode::message_data) return NotOffered{"publish"};
  if (opcode != ClientOpcode::service_request)
    throw ProtocolError("a binary message has an unknown opcode " + std::to_string(static_cast<int>(bytes.front())));
  BytesReader reader(bytes.subspan(1));
  ServiceCall call;
  call.service = reader.number();
  call.call = reader.number();
  call.encoding = reader.text(reader.number());
  call.payload = reader.rest();
  return call;
}

std::string server_info(const std::string& name, const std::string& session) {
  return text_of(Json{{"op", "serverInfo"},
                      {"name", name},
                      {"capabilities", {"services"}},
                      {"supportedEncodings", {"json"}},
                      {"sessionId", session}});
}

std::string advertise_channels() {
  Json channels = Json::array();
  for (std::uint32_t id = 0; id < topic_count; ++id) {
    const TopicInfo& topic = topic_table().at(id);
    channels.push_back({{"id", id},
                        {"topic", topic.name},
                        {"encoding", "cdr"},
                        {"schemaName", topic.schema_name},
                        {"schema", topic.schema},
                        {"schemaEncoding", "ros2msg"}});
  }
  return text_of(Json{{"op", "advertise"}, {"channels", channels}});
}

std::string advertise_services() {
  const Json control = {{"id", control_service},
                        {"name", "/cohort/control"},
                        {"type", "cohort_msgs/srv/Control"},
                        {"request", schema_of_json("cohort_msgs/srv/Control_Request")},
                        {"response", schema_of_json("cohort_msgs/srv/Control_Response")}};
  return text_of(Json{{"op", "advertiseServices"}, {"services", {control}}});
}

std::string status(StatusLevel level, const std::string& message) {
  return text_of(Json{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string service_failure(const ServiceCall& call, const std::string& message) {
  return text_of(
      Json{{"op", "serviceCallFailure"}, {"serviceId", call.service}, {"callId", call.call}, {"message", message}});
}

std::array<std::byte, 13> message_head(std::uint32_t subscription, std::chrono::nanoseconds time) {
  recording::Bytes bytes;
  bytes.reserve(13);
  append(bytes, FromServer::message_data);
  append(bytes, subscription);
  append(bytes, static_cast<std::uint64_t>(time.count()));
  std::array<std::byte, 13> head{};
  std::ranges::copy(bytes, head.begin());
  return head;
}

recording::Bytes service_response(const ServiceCall& call, const std::string& payload) {
  recording::Bytes bytes;
  append(bytes, FromServer::service_response);
  append(bytes, call.service);
  append(bytes, call.call);
  append(bytes, static_cast<std::uint32_t>(call.encoding.size()));
  append_text(bytes, call.encoding);
  append_text(bytes, payload);
  return bytes;
}

}  // namespace cohort::view::protocol
