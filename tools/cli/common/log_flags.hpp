// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/cli/common/command_line.hpp"
#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// Options of the command line for messages.
struct LogFlags {
  std::string format{};
  bool verbose = false;
  bool quiet = false;
};

/// Adds the options for format and verbosity. `flags` must outlive the command line.
void add_log_flags(CommandLine line, LogFlags& flags);

/// Returns the options that the flags select; by default, those of $COHORT_LOG and $COHORT_LOG_FORMAT. Throws
/// UsageError.
LogOptions log_options(const LogFlags& flags);

/// Returns the message format that a command line selects, even if it cannot be parsed.
LogFormat format_of_unreadable(int argc, const char* const* argv);

}  // namespace cohort::tool
