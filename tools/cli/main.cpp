// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "idl/text/standard_streams.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/build_facts.hpp"

namespace {

using namespace cohort::tool;

// Returns the commands in the order of help. `flags` must outlive `app`.
std::vector<Subcommand> add_commands(CommandLine app, LogFlags& flags) {
  std::vector<Subcommand> commands;
  for (const auto add : {add_run, add_serve, add_host}) commands.push_back(add(app, flags));
  for (const auto add : {
           add_teleop,   add_exec,     add_ctl,        add_record,     add_view,     add_page,
           add_film,     add_examples, add_check,      add_export,     add_models,   add_samples,
           add_security, add_doctor,   add_recordings, add_replay,     add_diff,     add_export_data,
           add_plot,     add_recover,  add_help,       add_completion, add_man_page, add_bench,
       }) {
    commands.push_back(add(app));
    add_log_flags(commands.back().line, flags);
  }
  return commands;
}

}  // namespace

int main(int argc, char** argv) {
  cohort::open_standard_streams();
  cohort::outlive_readers();
  CommandLine line("Cohort: a deterministic simulator for groups of robots", "cohort");
  line.set_version(version_text, "Print the version and build information");
  line.set_help("Print this help and exit");
  line.require_subcommand();
  LogFlags flags;
  add_log_flags(line, flags);
  line.footer(
      "Example: cohort run obstacle_avoidance --duration 10\n"
      "'cohort COMMAND --help' describes a command; 'cohort help' describes the elements and keys of files.\n"
      "Exit codes: 0 success, 1 the run failed, 2 an error in the command line, in a file or in the set-up, 130 "
      "interrupted.");
  const std::vector<Subcommand> commands = add_commands(line, flags);
  return run_program(line, flags, argc, argv, [&](Log& log, const std::atomic<bool>& stop) {
    return std::ranges::find_if(commands, [](const Subcommand& each) { return each.line.parsed(); })->run(log, stop);
  });
}
