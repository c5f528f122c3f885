// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cohort::tool {

/// Returns the arguments for `exec`, valid as long as `command`.
inline std::vector<char*> arguments_of(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

/// Returns the exit code for a status of `wait`: 128 plus the signal's number if a signal ended the process.
inline int exit_code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

/// Closes a descriptor that is not -1, and makes it -1.
inline void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

struct ProgramResult {
  int exit_code = 0;  ///< as exit_code_of
  std::string output;
  std::string errors;
};

/// Runs a program of $PATH to its end, in `folder`, with an empty standard input. Throws std::runtime_error that names
/// the missing package if it cannot be started.
ProgramResult run_program(const std::vector<std::string>& command, const std::filesystem::path& folder);

}  // namespace cohort::tool
