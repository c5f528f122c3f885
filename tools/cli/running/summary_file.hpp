// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/core/tick_stage.hpp"
#include "server/run/run.hpp"
#include "tools/cli/running/seed_table.hpp"

namespace cohort::tool {

/// Writes the summary as JSON; docs/cli.md lists its keys. `times`: empty if the stages were not measured. Throws
/// std::runtime_error with the reason if it cannot.
void write_summary(const std::filesystem::path& file, const description::Experiment& experiment,
                   const session::RunResult& result, double cpu_seconds, const StageTimes& times = {});

/// Reads the summary of the run with this number. Throws std::exception if the file is not a summary.
SeedRow read_seed_row(std::uint64_t run, const std::filesystem::path& file);

}  // namespace cohort::tool
