// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cohort::exec {

/// The program that a VirtualProgram runs, and its surroundings.
struct ProgramOptions {
  std::vector<std::string> command{};      ///< a program in $PATH or a path, and its arguments
  std::string name{};                      ///< name in messages to the user; empty: that of the program
  std::vector<std::string> environment{};  ///< NAME=VALUE, in addition to this process's
  std::filesystem::path folder{};          ///< working directory; empty: this process's
  std::chrono::nanoseconds start{0};       ///< initial time of its monotonic clock
  std::chrono::nanoseconds date{0};        ///< offset of its calendar clock (since 1970) from its monotonic clock
  /// Called in the new process between fork and exec. It may only make system calls, and not use the heap. Returns
  /// false, with errno set, if the program cannot be started.
  std::function<bool()> prepare{};
  std::function<bool()> given_up{};                     ///< asked several times a second while it computes
  std::function<void(const std::string& text)> tell{};  ///< reports problems to the user
};

}  // namespace cohort::exec
