#pragma once

#include <sys/wait.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cohort::tool {

/// As `exec` takes them; good as long as `command` is.
inline std::vector<char*> arguments_of(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

/// Of a process that `wait` told of: 128 and the signal's number if a signal ended it.
inline int exit_code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

struct ProgramResult {
  int exit_code = 0;  ///< as exit_code_of
  std::string output;
  std::string errors;
};

/// Runs a program of $PATH to its end, in `folder`, with an empty standard input. Throws std::runtime_error that says
/// what is missing if it cannot be started.
ProgramResult run_program(const std::vector<std::string>& command, const std::filesystem::path& folder);

}  // namespace cohort::tool
