#pragma once

#include <string>

#include "tools/cohort/cli/command_line.hpp"
#include "tools/cohort/cli/log.hpp"

namespace cohort::tool {

/// What the command line says of messages.
struct LogFlags {
  std::string format{};
  bool verbose = false;
  bool quiet = false;
};

/// Format and verbosity. `flags` must outlive the command line.
void add_log_flags(CommandLine line, LogFlags& flags);

/// Where the flags say nothing, $COHORT_LOG and $COHORT_LOG_FORMAT do. Throws UsageError.
LogOptions log_options(const LogFlags& flags);

/// The format that is asked for by a command line that cannot be read, and so does not say it as such.
LogFormat format_of_unreadable(int argc, const char* const* argv);

}  // namespace cohort::tool
