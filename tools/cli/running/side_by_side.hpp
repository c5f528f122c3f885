// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "tools/cli/common/log.hpp"
#include "tools/cli/running/run_options.hpp"
#include "tools/cli/running/seed_table.hpp"

namespace cohort::tool {

/// Returns the reason why runs of this command cannot be parallel, such as "'--view'"; empty if they can.
std::string what_needs_one_job(const RunCommand& command, const description::Experiment& experiment);

/// Returns how many of `count` runs are executed in parallel: `command.jobs`, or if that is 0, one for each core that
/// this process may use. The default is 1 if runs cannot be parallel, or if their results depend on the speed of the
/// machine. Throws std::invalid_argument if `command.jobs` is not possible.
unsigned jobs_for(const RunCommand& command, const description::Experiment& experiment, std::size_t count);

/// Runs the command's experiment with each seed in a separate process, `jobs` of them in parallel, until one fails.
/// Calls `ended` with the results of each successful run when it ends. Returns the exit code.
int run_side_by_side(const RunCommand& command, const description::Experiment& experiment, unsigned jobs, Log& log,
                     const std::atomic<bool>& stop, const std::function<void(SeedRow)>& ended);

}  // namespace cohort::tool
