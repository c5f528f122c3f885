#pragma once

#include <filesystem>

#include "server/run/run.hpp"

namespace cohort::tool {

/// Writes the summary as JSON; docs/cli.md lists its keys. Throws std::runtime_error that says why it cannot.
void write_summary(const std::filesystem::path& file, const description::Experiment& experiment,
                   const session::RunResult& result, double cpu_seconds);

}  // namespace cohort::tool
