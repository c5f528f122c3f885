#include "tools/cohort/commands/page_commands.hpp"

#include <iostream>
#include <map>

#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/completion.hpp"
#include "tools/cohort/commands/man_page.hpp"
#include "tools/cohort/cli/usage.hpp"

namespace cohort::tool {
namespace {

const std::map<std::string, Shell> shells = {{"bash", Shell::bash}, {"zsh", Shell::zsh}, {"fish", Shell::fish}};

}  // namespace

PageCommands::PageCommands(CLI::App& app)
    : app_(app),
      completion_(app.add_subcommand("completion", "Print a script that completes command lines in a shell")),
      man_page_(app.add_subcommand("man-page", "Print the manual page, which tells what all of --help tell")) {
  completion_->add_option("SHELL", shell_, "Which one")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}))
      ->type_name("bash|zsh|fish");
  completion_->footer("Example: source <(cohort completion bash)");
  man_page_->footer("Example: cohort man-page | man -l -");
}

std::optional<int> PageCommands::run() const {
  if (completion_->parsed())
    std::cout << completion(command_tree(app_), shells.at(shell_));
  else if (man_page_->parsed())
    std::cout << man_page(command_tree(app_));
  else
    return std::nullopt;
  return exit_ok;
}

}  // namespace cohort::tool
