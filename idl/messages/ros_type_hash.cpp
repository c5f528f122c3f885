// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/ros_type_hash.hpp"

#include <openssl/evp.h>

#include <map>

namespace cohort::messages {
namespace {

// service_msgs/msg/ServiceEventInfo: the metadata of a service event.
struct ServiceEventInfo {
  std::uint8_t event_type = 0;
  ros::Time stamp{};
  std::array<char, 16> client_gid{};
  std::int64_t sequence_number = 0;
  static constexpr const char* type = "service_msgs/msg/ServiceEventInfo";
  static constexpr auto fields = std::tuple(
      field("event_type", &ServiceEventInfo::event_type), field("stamp", &ServiceEventInfo::stamp),
      field("client_gid", &ServiceEventInfo::client_gid), field("sequence_number", &ServiceEventInfo::sequence_number));
};

// Names contain only ASCII letters, digits, '_' and '/', so no character is escaped.
std::string json_of(const RosField& field) {
  return R"({"name": ")" + field.name + R"(", "type": {"type_id": )" + std::to_string(field.type.id) +
         R"(, "capacity": )" + std::to_string(field.type.capacity) + R"(, "string_capacity": )" +
         std::to_string(field.type.string_capacity) + R"(, "nested_type_name": ")" + field.type.nested_type + R"("}})";
}

template <class Elements>
std::string json_list(const Elements& elements) {
  std::string text;
  for (const std::string& element : elements) text += (text.empty() ? "" : ", ") + element;
  return "[" + text + "]";
}

std::string json_of(const RosDefinition& message) {
  std::vector<std::string> fields;
  for (const RosField& field : message.fields) fields.push_back(json_of(field));
  if (fields.empty()) fields.push_back(json_of(RosField{"structure_needs_at_least_one_member", {RosFieldType::uint8}}));
  return R"({"type_name": ")" + message.type + R"(", "fields": )" + json_list(fields) + "}";
}

// Sorted by name, which is the order in the description.
void add_parts(std::map<std::string, std::string>& known, const RosDefinition& message) {
  for (const RosDefinition& part : message.parts)
    if (known.emplace(part.type, json_of(part)).second) add_parts(known, part);
}

std::string sha256(const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL has no SHA-256");
  std::string hex;
  for (unsigned int i = 0; i < size; ++i)
    for (const int shift : {4, 0}) hex += "0123456789abcdef"[(digest[i] >> shift) & 0xF];
  return hex;
}

}  // namespace

std::string type_hash(const RosDefinition& message) {
  std::map<std::string, std::string> parts;
  add_parts(parts, message);
  std::vector<std::string> descriptions;
  for (const auto& [name, description] : parts) descriptions.push_back(description);
  return "RIHS01_" + sha256(R"({"type_description": )" + json_of(message) + R"(, "referenced_type_descriptions": )" +
                            json_list(descriptions) + "}");
}

std::string service_type_hash(const std::string& service, const RosDefinition& request, const RosDefinition& response) {
  const auto part = [](std::string name, const RosDefinition& of) {
    return RosField{std::move(name), {RosFieldType::nested, 0, 0, of.type}};
  };
  // An event has a request, a response, or neither.
  const auto at_most_one = [](std::string name, const RosDefinition& of) {
    return RosField{std::move(name), {RosFieldType::nested + RosFieldType::bounded_sequence, 1, 0, of.type}};
  };
  const RosDefinition info = definition<ServiceEventInfo>();
  const RosDefinition event{"",
                            "",
                            {info, request, response},
                            service + "_Event",
                            {part("info", info), at_most_one("request", request), at_most_one("response", response)}};
  return type_hash(RosDefinition{
      "",
      "",
      {request, response, event},
      service,
      {part("request_message", request), part("response_message", response), part("event_message", event)}});
}

}  // namespace cohort::messages
