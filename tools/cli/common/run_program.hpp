// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>

#include "tools/cli/common/command_line.hpp"
#include "tools/cli/common/log.hpp"
#include "tools/cli/common/log_flags.hpp"

namespace cohort::tool {

/// Executes a command, and returns the process's exit code. An exception is a user's error and ends the process with
/// exit_usage.
using CommandFunction = std::function<int(Log& log, const std::atomic<bool>& stop)>;

/// Parses the command line of a program, and calls `run` with a log that also shows messages of DDS. Logs its
/// exceptions. Returns the exit code of the process. The options of `line` write `flags`.
int run_program(CommandLine line, const LogFlags& flags, int argc, const char* const* argv, const CommandFunction& run);

}  // namespace cohort::tool
