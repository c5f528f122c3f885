// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// The announcements of ROS 2 participants about their nodes, on the topic `ros_discovery_info`
/// (rmw_dds_common/msg/ParticipantEntitiesInfo).
namespace cohort::ros2 {

/// The GUID of a DDS participant, writer or reader.
using Gid = std::array<std::uint8_t, 16>;

/// Size of a Gid on the network: releases up to Humble pad it to 24 bytes.
enum class GidFormat { humble, since_iron };

struct NodeInfo {
  std::string name_space{};  ///< begins with `/`
  std::string name{};
  std::vector<Gid> readers{};
  std::vector<Gid> writers{};
};

struct ParticipantInfo {
  Gid participant{};
  std::vector<NodeInfo> nodes{};
};

inline constexpr const char* discovery_topic = "ros_discovery_info";
inline constexpr const char* discovery_type = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
/// Returns the hash of this type from Iron on (REP 2016), as in rmw_dds_common 2 and later.
std::string discovery_type_hash();

std::vector<std::byte> encode_discovery(const ParticipantInfo& info, GidFormat format);
/// Returns the size of the Gids in a message. It is taken from the message itself, because not every participant
/// announces the hash of its type.
GidFormat gid_format_of(std::span<const std::byte> bytes);
/// Decodes a message with Gids of either size. Throws messages::CdrError.
ParticipantInfo decode_discovery(std::span<const std::byte> bytes);

}  // namespace cohort::ros2
