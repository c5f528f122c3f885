// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_schema.hpp"

/// Messages of ROS 2's rmw_dds_common on the topic `ros_discovery_info`: the nodes of a participant and their
/// endpoints.
namespace cohort::messages::ros {

/// The GUID of a participant or an endpoint. It has 16 bytes since the release Iron. In Humble, it is a `char[24]`,
/// whose last 8 bytes are 0.
template <std::size_t size>
struct GidOf {
  std::array<std::uint8_t, size> data{};
  static constexpr const char* type = "rmw_dds_common/msg/Gid";
  static constexpr auto fields = std::tuple(field("data", &GidOf::data));
  bool operator==(const GidOf&) const = default;
};

template <std::size_t gid_size>
struct NodeEntitiesInfoOf {
  std::string node_namespace{};
  std::string node_name{};
  std::vector<GidOf<gid_size>> reader_gid_seq{};
  std::vector<GidOf<gid_size>> writer_gid_seq{};
  static constexpr std::size_t longest_name = 256;
  static constexpr const char* type = "rmw_dds_common/msg/NodeEntitiesInfo";
  static constexpr auto fields = std::tuple(field("node_namespace", &NodeEntitiesInfoOf::node_namespace, longest_name),
                                            field("node_name", &NodeEntitiesInfoOf::node_name, longest_name),
                                            field("reader_gid_seq", &NodeEntitiesInfoOf::reader_gid_seq),
                                            field("writer_gid_seq", &NodeEntitiesInfoOf::writer_gid_seq));
  bool operator==(const NodeEntitiesInfoOf&) const = default;
};

template <std::size_t gid_size>
struct ParticipantEntitiesInfoOf {
  GidOf<gid_size> gid{};
  std::vector<NodeEntitiesInfoOf<gid_size>> node_entities_info_seq{};
  static constexpr const char* type = "rmw_dds_common/msg/ParticipantEntitiesInfo";
  static constexpr auto fields =
      std::tuple(field("gid", &ParticipantEntitiesInfoOf::gid),
                 field("node_entities_info_seq", &ParticipantEntitiesInfoOf::node_entities_info_seq));
  bool operator==(const ParticipantEntitiesInfoOf&) const = default;
};

using Gid = GidOf<16>;
using NodeEntitiesInfo = NodeEntitiesInfoOf<16>;
using ParticipantEntitiesInfo = ParticipantEntitiesInfoOf<16>;
using HumbleParticipantEntitiesInfo = ParticipantEntitiesInfoOf<24>;

}  // namespace cohort::messages::ros
