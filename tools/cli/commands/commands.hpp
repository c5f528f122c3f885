// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/cli/common/command_line.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/log.hpp"
#include "tools/cli/common/log_flags.hpp"
#include "tools/cli/common/run_program.hpp"

/// The commands of `cohort`, one file each. Commands that no run needs and that take long to build are only in a second
/// program, `cohort-whole`, which has all commands. `in_whole` lists these commands; `cohort` starts `cohort-whole` for
/// them.
namespace cohort::tool {

/// A command: its part of the command line, and the function that executes it.
struct Subcommand {
  CommandLine line;
  CommandFunction run;
};

/// A command that only `cohort-whole` has.
struct InWhole {
  const char* name;
  const char* text;  ///< for help
};
namespace in_whole {
inline constexpr InWhole view = {"view", "Show a recording or a running server in a browser"};
inline constexpr InWhole page = {"page", "Write a recording as one HTML file that plays in any browser"};
inline constexpr InWhole film = {"film", "Make a film or pictures of a recording"};
inline constexpr InWhole completion = {"completion", "Print a shell's completion script"};
inline constexpr InWhole man_page = {"man-page", "Print the manual page, which contains the help of all commands"};
}  // namespace in_whole

/// Each function adds its command to `app`. The functions that take `flags` show the message options after their own in
/// help.
Subcommand add_run(CommandLine app, LogFlags& flags);
Subcommand add_serve(CommandLine app, LogFlags& flags);
Subcommand add_host(CommandLine app, LogFlags& flags);
Subcommand add_teleop(CommandLine app);
Subcommand add_exec(CommandLine app);
Subcommand add_ctl(CommandLine app);
Subcommand add_record(CommandLine app);
Subcommand add_view(CommandLine app);
Subcommand add_page(CommandLine app);
Subcommand add_film(CommandLine app);
Subcommand add_examples(CommandLine app);
Subcommand add_check(CommandLine app);
Subcommand add_export(CommandLine app);
Subcommand add_models(CommandLine app);
Subcommand add_samples(CommandLine app);
Subcommand add_security(CommandLine app);
Subcommand add_doctor(CommandLine app);
Subcommand add_recordings(CommandLine app);
Subcommand add_replay(CommandLine app);
Subcommand add_diff(CommandLine app);
Subcommand add_export_data(CommandLine app);
Subcommand add_plot(CommandLine app);
Subcommand add_recover(CommandLine app);
Subcommand add_help(CommandLine app);
Subcommand add_completion(CommandLine app);
Subcommand add_man_page(CommandLine app);
Subcommand add_bench(CommandLine app);

}  // namespace cohort::tool
