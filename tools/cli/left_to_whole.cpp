#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "tools/cli/commands/commands.hpp"

// Stubs in `cohort` for the commands of cohort-whole.
namespace cohort::tool {
namespace {

// Returns the command line of this process.
std::vector<std::string> own_words() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

// Replaces this process with cohort-whole, with the same command line.
int become_whole(const char* command, Log& log) {
  const std::filesystem::path whole = std::filesystem::read_symlink("/proc/self/exe").replace_filename("cohort-whole");
  std::vector<std::string> words = own_words();
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(whole.c_str(), arguments.data());
  const int error = errno;
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
Subcommand add_bench(CommandLine app) { return add_left(std::move(app), in_whole::bench); }

}  // namespace cohort::tool
