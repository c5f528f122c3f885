// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/description/experiment.hpp"
#include "tools/cli/running/run_options.hpp"

namespace cohort::tool {

/// Applies the recording options of the command line to the experiment. Throws std::invalid_argument for a selector
/// that selects no robot.
void set_recorded(description::Experiment& experiment, const RecordOptions& options);

/// Throws std::runtime_error if the folder of a recording is a rosbag2 bag of other files. Called before a long run.
void check_rosbag2_metadata(const std::filesystem::path& recording);

/// Writes `metadata.yaml` beside a recording, so that rosbag2 reads the folder as a bag. Throws std::runtime_error if
/// the recording is damaged, or the folder is a bag of other files.
void write_rosbag2_metadata(const std::filesystem::path& recording);

}  // namespace cohort::tool
