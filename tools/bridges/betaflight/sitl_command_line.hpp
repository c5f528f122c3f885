// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "tools/bridges/common/descriptor.hpp"

namespace cohort::betaflight {

/// Thrown if a program does not start to respond in time.
struct Silent : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A connection to the command line of a flight controller, on its TCP port. For set-up only, because it blocks.
class CommandLine {
 public:
  /// Connects `socket` as soon as the program listens, even if it was connected before, and waits for the prompt. Calls
  /// `check` while waiting, which may throw to end the wait. Throws Silent after `patience`.
  CommandLine(const bridges::Descriptor& socket, std::chrono::seconds patience, std::function<void()> check);

  /// Throws std::runtime_error if the program does not know or accept the command.
  void execute(const std::string& command);

  /// Saves the configuration, upon which the program ends.
  void save();

 private:
  void connect();
  void send(const std::string& text) const;
  void enter();
  std::string read_to_prompt(const std::string& of);
  std::optional<std::string> find_prompt(std::chrono::milliseconds at_most);

  int socket_;
  std::chrono::seconds patience_;
  std::function<void()> check_;
};

}  // namespace cohort::betaflight
