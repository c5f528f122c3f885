// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "tools/common/drawing/viewpoint.hpp"

namespace cohort::tool {

/// The files that a run writes (OneRun); an empty path: no such file.
struct Outputs {
  std::filesystem::path summary{};
  std::filesystem::path plot{};
  Viewpoint viewpoint = Viewpoint::above;  ///< viewpoint of the plot
  std::filesystem::path recording{};
  std::filesystem::path csv{};  ///< values that the experiment prints
};

/// Returns the files of one of `count` runs: each run has its own, for example `summary-2.json` instead of
/// `summary.json` for the second run.
Outputs numbered(const Outputs& outputs, std::size_t number, std::size_t count);

/// Returns the outputs of one of the runs of `--seeds`: as `numbered`, but its printed values always have a number. The
/// file without a number has the table of all runs.
Outputs numbered_by_seed(const Outputs& outputs, std::size_t number, std::size_t count);

/// Checks before a long run that all files can be written. Throws std::runtime_error that names the file and the
/// reason, and std::invalid_argument if the plot's extension is unknown.
void check_writable(const Outputs& outputs);

}  // namespace cohort::tool
