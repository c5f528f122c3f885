#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "tools/cohort/cli/command_line.hpp"
#include "tools/cohort/cli/exit_codes.hpp"
#include "tools/cohort/cli/log.hpp"
#include "tools/cohort/cli/log_flags.hpp"

/// The commands of `cohort`, one file each.
namespace cohort::tool {

/// A command: its part of the command line, and what it does once that is parsed.
struct Subcommand {
  CommandLine line;
  /// Returns the process's exit code. What it throws is a mistake of the user, and ends the process with exit_usage.
  std::function<int(Log& log, const std::atomic<bool>& stop)> run;
};

/// Each adds its command to `app`. Those that take the flags of messages have options that follow them in help.
Subcommand add_run(CommandLine app, LogFlags& flags);
Subcommand add_serve(CommandLine app, LogFlags& flags);
Subcommand add_host(CommandLine app, LogFlags& flags);
Subcommand add_teleop(CommandLine app);
Subcommand add_ctl(CommandLine app);
Subcommand add_record(CommandLine app);
Subcommand add_view(CommandLine app);
Subcommand add_check(CommandLine app);
Subcommand add_export(CommandLine app);
Subcommand add_samples(CommandLine app);
Subcommand add_security(CommandLine app);
Subcommand add_doctor(CommandLine app);
Subcommand add_replay(CommandLine app);
Subcommand add_diff(CommandLine app);
Subcommand add_export_data(CommandLine app);
Subcommand add_plot(CommandLine app);
Subcommand add_recover(CommandLine app);
Subcommand add_help(CommandLine app);
Subcommand add_completion(CommandLine app);
Subcommand add_man_page(CommandLine app);
Subcommand add_bench(CommandLine app);

/// Adds all of them to `app`, in the order of help. `flags` must outlive it.
std::vector<Subcommand> add_commands(CommandLine app, LogFlags& flags);

/// Runs the one that was asked for, and logs what it throws. The exit code.
int run_chosen(const std::vector<Subcommand>& commands, Log& log, const std::atomic<bool>& stop);

}  // namespace cohort::tool
