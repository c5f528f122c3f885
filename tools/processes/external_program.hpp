#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cohort::tool {

struct ProgramResult {
  int exit_code = 0;  ///< 128 and the signal's number if a signal ended it
  std::string output;
  std::string errors;
};

/// Runs a program of $PATH to its end, in `folder`, with an empty standard input. Throws std::runtime_error that says
/// what is missing if it cannot be started.
ProgramResult run_program(const std::vector<std::string>& command, const std::filesystem::path& folder);

}  // namespace cohort::tool
