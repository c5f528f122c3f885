// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/become.hpp"

// Stubs in `cohort` for the commands of cohort-whole.
namespace cohort::tool {
namespace {

// Replaces this process with cohort-whole, with the same command line.
int become_whole(const char* command, Log& log) {
  const std::filesystem::path whole = path_beside("cohort-whole");
  const int error = become(whole, own_words());
  if (error == ENOENT)
    log.error(
        fmt::format("'cohort {}' requires the program {}, which does not exist; 'cmake --build --preset release "
                    "--target cohort-whole view_page' builds it",
                    command, whole.string()));
  else
    log.error(fmt::format("cannot start {}: {}", whole.string(), std::system_category().message(error)));
  return exit_usage;
}

Subcommand add_left(CommandLine app, const InWhole& command) {
  CommandLine line = app.add_subcommand(command.name, command.text);
  line.take_all();
  return {line, [name = command.name](Log& log, const std::atomic<bool>&) { return become_whole(name, log); }};
}

}  // namespace

Subcommand add_view(CommandLine app) { return add_left(std::move(app), in_whole::view); }
Subcommand add_page(CommandLine app) { return add_left(std::move(app), in_whole::page); }
Subcommand add_film(CommandLine app) { return add_left(std::move(app), in_whole::film); }
Subcommand add_completion(CommandLine app) { return add_left(std::move(app), in_whole::completion); }
Subcommand add_man_page(CommandLine app) { return add_left(std::move(app), in_whole::man_page); }

}  // namespace cohort::tool
