#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "tools/bridges/common/descriptor.hpp"

namespace cohort::betaflight {

/// A program that does not begin to respond.
struct Silent : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A conversation with the command line of a flight controller, at its TCP port. Set-up only: it blocks.
class CommandLine {
 public:
  /// Connects `socket` as soon as the program listens, also if it was connected before, and waits for the prompt.
  /// `check` is called while it waits, and throws to end that. Throws Silent after `patience`.
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
