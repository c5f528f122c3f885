// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/recording/mcap/reading/mcap_reader.hpp"

namespace cohort::recording {

/// The name of the file that makes a folder a bag for rosbag2.
inline constexpr const char* rosbag2_metadata_name = "metadata.yaml";

/// Returns the type hash of a channel, as defined by ROS 2 from Iron on; empty if the channel is not of ROS 2, or its
/// schema cannot be read.
std::string channel_type_hash(const McapReader& reader, const Channel& channel);

/// Returns the text of `metadata.yaml` for a bag that consists of the file `file_name`. It uses version 8 of rosbag2's
/// format, the first with all these fields; readers from Humble on understand it.
std::string rosbag2_metadata(const McapReader& reader, const std::string& file_name);

}  // namespace cohort::recording
