// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/files.hpp"
#include "tests/support/process.hpp"
#include "tools/exec/virtual_program.hpp"

namespace cohort::test {

using exec::VirtualProgram;

/// Runs a program through so much of its time, and returns what it wrote to its standard output.
struct Ran {
  std::string output;
  std::optional<int> exit_code;
  std::chrono::nanoseconds time;
  std::vector<std::string> told;
};
inline Ran run(const std::vector<std::string>& command, std::chrono::nanoseconds at_most = 100s) {
  const ScratchFolder folder;
  Ran ran;
  VirtualProgram::Options options;
  options.command = {"sh", "-c", "exec \"$@\" > output", "sh"};
  options.command.insert(options.command.end(), command.begin(), command.end());
  options.folder = folder.path();
  options.tell = [&](const std::string& text) { ran.told.push_back(text); };
  VirtualProgram program(options);
  while (program.time() < at_most && program.run_now() && program.run_before(program.time() + 10ms)) {
  }
  ran.exit_code = program.exit_code();
  ran.time = program.time();
  ran.output = read_file(folder / "output");
  return ran;
}

}  // namespace cohort::test
