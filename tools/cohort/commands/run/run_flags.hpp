#pragma once

#include "tools/cohort/cli/command_line.hpp"
#include "tools/cohort/cli/log_flags.hpp"
#include "tools/cohort/running/run_options.hpp"

namespace cohort::tool {

/// Adds the options that `cohort run` and `cohort serve` share. `command` and `flags` must outlive `line`.
void add_run_options(CommandLine line, RunCommand& command, LogFlags& flags);

}  // namespace cohort::tool
