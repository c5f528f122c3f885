// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/discovery_info.hpp"

#include <algorithm>

#include "idl/messages/ros_discovery_messages.hpp"
#include "idl/messages/ros_type_hash.hpp"

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;

template <std::size_t size>
ros::GidOf<size> to_message(const Gid& gid) {
  ros::GidOf<size> message;
  std::ranges::copy(gid, message.data.begin());
  return message;
}
template <std::size_t size>
Gid from_message(const ros::GidOf<size>& message) {
  Gid gid{};
  std::copy_n(message.data.begin(), gid.size(), gid.begin());
  return gid;
}

template <class To, class From, class Convert>
std::vector<To> converted(const std::vector<From>& from, const Convert& convert) {
  std::vector<To> to;
  to.reserve(from.size());
  std::ranges::transform(from, std::back_inserter(to), convert);
  return to;
}

template <std::size_t size>
std::vector<std::byte> encode_as(const ParticipantInfo& info) {
  ros::ParticipantEntitiesInfoOf<size> message{to_message<size>(info.participant), {}};
  for (const NodeInfo& node : info.nodes)
    message.node_entities_info_seq.push_back({node.name_space, node.name,
                                              converted<ros::GidOf<size>>(node.readers, to_message<size>),
                                              converted<ros::GidOf<size>>(node.writers, to_message<size>)});
  return messages::encode(message);
}

template <std::size_t size>
ParticipantInfo decode_as(std::span<const std::byte> bytes) {
  const auto message = messages::decode<ros::ParticipantEntitiesInfoOf<size>>(bytes);
  ParticipantInfo info{from_message<size>(message.gid), {}};
  for (const auto& node : message.node_entities_info_seq)
    info.nodes.push_back({node.node_namespace, node.node_name, converted<Gid>(node.reader_gid_seq, from_message<size>),
                          converted<Gid>(node.writer_gid_seq, from_message<size>)});
  return info;
}

constexpr std::size_t humble_size = 24;
constexpr std::size_t iron_size = 16;
constexpr std::size_t encapsulation_size = 4;

}  // namespace

std::string discovery_type_hash() { return messages::type_hash<ros::ParticipantEntitiesInfo>(); }

std::vector<std::byte> encode_discovery(const ParticipantInfo& info, GidFormat format) {
  return format == GidFormat::humble ? encode_as<humble_size>(info) : encode_as<iron_size>(info);
}

GidFormat gid_format_of(std::span<const std::byte> bytes) {
  // 1 character plus NUL. A long Gid has eight zeros there. A short message without nodes has no data after their
  // number.
  constexpr std::size_t end_of_humble = encapsulation_size + humble_size;
  if (bytes.size() < end_of_humble + sizeof(std::uint32_t)) return GidFormat::since_iron;
  const auto rest = bytes.first(end_of_humble).subspan(encapsulation_size + iron_size);
  const bool is_filled_up = std::ranges::all_of(rest, [](std::byte each) { return each == std::byte{0}; });
  return is_filled_up ? GidFormat::humble : GidFormat::since_iron;
}

ParticipantInfo decode_discovery(std::span<const std::byte> bytes) {
  return gid_format_of(bytes) == GidFormat::humble ? decode_as<humble_size>(bytes) : decode_as<iron_size>(bytes);
}

}  // namespace cohort::ros2
