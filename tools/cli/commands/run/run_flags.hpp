// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/cli/common/command_line.hpp"
#include "tools/cli/common/log_flags.hpp"
#include "tools/cli/running/run_options.hpp"

namespace cohort::tool {

/// Adds the options that `cohort run` and `cohort serve` share. `command` and `flags` must outlive `line`.
void add_run_options(CommandLine line, RunCommand& command, LogFlags& flags);

}  // namespace cohort::tool
