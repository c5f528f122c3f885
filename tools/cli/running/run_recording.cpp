// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/run_recording.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "server/description/select_robots.hpp"
#include "server/recording/rosbag2_metadata.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

std::filesystem::path metadata_beside(const std::filesystem::path& recording) {
  return recording.parent_path() / recording::rosbag2_metadata_name;
}

}  // namespace

void set_recorded(description::Experiment& experiment, const RecordOptions& options) {
  description::Recorded& recorded = experiment.recorded;
  recorded.pose_rate = options.pose_rate.value_or(recorded.pose_rate);
  recorded.joint_rate = options.joint_rate.value_or(recorded.joint_rate);
  recorded.observation_rate = options.observation_rate.value_or(recorded.observation_rate);
  if (options.snapshot_interval) recorded.snapshot_interval = nanoseconds(*options.snapshot_interval);
  if (options.robots.empty()) return;
  recorded.observed = description::select_robots(experiment.world, options.robots);
  recorded.selectors = options.robots;
}

void check_rosbag2_metadata(const std::filesystem::path& recording) {
  const std::filesystem::path metadata = metadata_beside(recording);
  std::ifstream file(metadata);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!text.empty() && text.find(recording.filename().string()) == std::string::npos)
    throw std::runtime_error(
        fmt::format("{} describes recordings other than {}; each rosbag2 bag requires its own folder",
                    metadata.string(), recording.filename().string()));
  check_writable("the rosbag2 metadata", metadata);
}

void write_rosbag2_metadata(const std::filesystem::path& recording) {
  check_rosbag2_metadata(recording);
  const recording::McapReader reader(recording);
  if (!reader.is_complete())
    throw std::runtime_error(
        fmt::format("{}; 'cohort recover {}' makes it readable for rosbag2", reader.damage(), recording.string()));
  write_file("the rosbag2 metadata", metadata_beside(recording),
             recording::rosbag2_metadata(reader, recording.filename().string()));
}

}  // namespace cohort::tool
