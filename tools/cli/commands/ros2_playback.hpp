// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "tools/cli/commands/recording_part.hpp"
#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// Options of playing a recording to ROS 2 nodes.
struct Ros2Playback {
  std::filesystem::path file;
  RecordingPart part{};
  double speed = 1.0;                     ///< limit in recorded seconds per second; 0: no limit
  bool loops = false;                     ///< repeat until stopped
  bool quiet = false;                     ///< print errors only
  std::uint64_t awaited = 0;              ///< number of subscriptions to wait for before the start
  std::optional<std::uint64_t> domain{};  ///< ROS domain; none: $ROS_DOMAIN_ID
};

/// Publishes the messages of a recording for ROS 2 nodes, unchanged, in the order of their log times. Returns the exit
/// code. Skips the topics by which Cohort replays a run, and observations, whose types are in no ROS 2 package. Throws
/// std::invalid_argument if no topic remains, McapError, or wire::WireError.
int play_to_ros2(const Ros2Playback& playback, Log& log, const std::atomic<bool>& stop);

}  // namespace cohort::tool
