#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cohort::exec {

/// The program that a VirtualProgram runs, and its surroundings.
struct ProgramOptions {
  std::vector<std::string> command{};      ///< a program of $PATH or its path, and its arguments
  std::string name{};                      ///< for people; empty: that of the program
  std::vector<std::string> environment{};  ///< NAME=VALUE, in addition to this process's
  std::filesystem::path folder{};          ///< that it runs in; empty: this process's
  std::chrono::nanoseconds start{0};       ///< its monotonic clock at first
  std::chrono::nanoseconds date{0};        ///< offset of its calendar clock (since 1970) from that
  /// Called in the new process before it becomes the program, after a fork: system calls alone, no memory of the
  /// heap. Returns false, with errno, if it cannot be started so.
  std::function<bool()> prepare{};
  std::function<bool()> given_up{};                     ///< asked while it computes, several times a second
  std::function<void(const std::string& text)> tell{};  ///< reports problems to the user
};

}  // namespace cohort::exec
