// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace cohort::tool {

/// Throws std::invalid_argument if `file`, which was given as a recording, is an experiment, a world or a model, or the
/// name of one that comes with Cohort. The message names the command line that runs it with `option`, such as
/// `--plot run.svg`.
void refuse_experiment(const std::filesystem::path& file, const std::string& option = "--record run.mcap");

}  // namespace cohort::tool
