// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "server/description/experiment.hpp"
#include "tools/cli/running/run_options.hpp"

/// Checks that reject combinations of options and experiments. All throw std::invalid_argument or InputError.
namespace cohort::tool {

/// Rejects the controller `keyboard`, for a run in one process.
void refuse_keyboard(const description::Experiment& experiment);
/// Rejects options that need a server, for a run in one process.
void refuse_what_needs_a_server(const RunCommand& command);
void refuse_rewind_without_snapshots(const RunCommand& command, const description::Experiment& experiment);
/// Checks options for a rosbag2 bag, which is a folder with one recording.
void check_rosbag2(const RunCommand& command, std::size_t runs);

}  // namespace cohort::tool
