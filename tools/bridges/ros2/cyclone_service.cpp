// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/cyclone_service.hpp"

#include <algorithm>
#include <string_view>

#include "idl/dds/ros2/ros_names.hpp"

namespace cohort::ros2 {
namespace {

constexpr std::size_t encapsulation = 4;  // bytes before the header
constexpr std::size_t body = encapsulation + std::tuple_size_v<decltype(CycloneRequest::header)>;
// The server takes no request that is larger than 4 MiB.
constexpr std::size_t largest_request = std::size_t{5} << 20;
// Services keep the last 10. More on our side loses nothing when many clients ask at once.
constexpr EndpointQos service_qos{.is_reliable = true, .is_transient_local = false, .depth = 1000};

// As rmw_cyclonedds marks the two endpoints of a service as one.
std::string service_id(const Gid& participant, std::size_t input) {
  constexpr std::string_view digits = "0123456789abcdef";
  Gid id = participant;
  id[14] = static_cast<std::uint8_t>(input >> 8);
  id[15] = static_cast<std::uint8_t>(input);
  std::string text;
  for (const std::uint8_t byte : id) {
    if (!text.empty()) text += '.';
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

std::string type_hash_of(const OfferedService& service) { return "typehash=" + service.type_hash + ";"; }

EndpointSpec endpoint(const RosParticipant& participant, const OfferedService& service, std::size_t input,
                      TopicKind kind) {
  const char* const part = kind == TopicKind::request ? "_Request" : "_Response";
  return {dds_topic(kind, service.name), dds_type(service.type + part),
          "serviceid=" + service_id(participant.gid(), input) + ";" + type_hash_of(service), service_qos};
}

EndpointSpec counted_endpoint(EndpointSpec of_replies, const OfferedService& service) {
  of_replies.user_data = type_hash_of(service);
  return of_replies;
}

// The value of a key in user data, such as `clientid=…;`; empty if it is not there.
std::string value_of(std::string_view user_data, std::string_view key) {
  while (!user_data.empty()) {
    const std::string_view pair = user_data.substr(0, user_data.find(';'));
    user_data.remove_prefix(std::min(user_data.size(), pair.size() + 1));
    if (pair.starts_with(key) && pair.substr(key.size()).starts_with('='))
      return std::string(pair.substr(key.size() + 1));
  }
  return {};
}

}  // namespace

CycloneService::CycloneService(RosParticipant& participant, RosInbox& inbox, const OfferedService& service,
                               std::size_t input)
    : writer_(participant, endpoint(participant, service, input, TopicKind::reply), [&inbox] { inbox.wake(); }),
      counted_writer_(participant, counted_endpoint(endpoint(participant, service, input, TopicKind::reply), service)),
      reader_(participant, endpoint(participant, service, input, TopicKind::request),
              [&inbox, input](const Received& received) {
                if (received.bytes.size() > largest_request) return;
                inbox.put({input, {received.bytes.begin(), received.bytes.end()}, received.writer});
              }) {}

std::optional<CycloneRequest> CycloneService::request(const RosInbox::Message& message) const {
  const auto user_data = reader_.user_data_of_writer(message.writer);
  if (!user_data || message.bytes.size() < body) return {};
  CycloneRequest request;
  request.client = value_of(*user_data, "clientid");
  if (request.client.empty()) return {};
  const auto header = message.bytes.begin() + encapsulation;
  std::copy_n(header, request.header.size(), request.header.begin());
  request.request = message.bytes;
  request.request.erase(request.request.begin() + encapsulation, request.request.begin() + body);
  return request;
}

bool CycloneService::is_there(const std::string& client) const {
  return std::ranges::any_of(writer_.user_data_of_readers(),
                             [&](const std::string& user_data) { return value_of(user_data, "clientid") == client; });
}

void CycloneService::reply(const CycloneRequest& to, messages::ByteView reply) {
  messages::Bytes bytes(reply.begin(), reply.end());
  bytes.insert(bytes.begin() + encapsulation, to.header.begin(), to.header.end());
  writer_.write(bytes);
}

}  // namespace cohort::ros2
