// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/bridges/common/robot_bridge.hpp"

namespace cohort::bridges {

/// An error in the command-line options of a bridge.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command line of a bridge's program: the options that all bridges have, to which each adds its own.
class BridgeProgram {
 public:
  /// `name` is the program's name. `who` is the word in messages for what drives a robot, such as `firmware`.
  BridgeProgram(std::string name, std::string who, const std::string& text);

  /// Adds the option --run, the command of a program that is started in virtual time for each robot. `text` is the
  /// option's help text.
  void offer_to_run_programs(const std::string& text =
                                 "Shell command of a program that drives a robot: started once for each robot, with "
                                 "simulated time as its clock");
  /// Returns the command of --run; empty if there was none.
  const std::string& command() const { return command_; }

  CLI::App& app() { return app_; }
  Patience& patience() { return patience_; }

  /// Adds an option whose value is one of `choices`.
  template <class Value>
  void add_choice(const std::string& option, Value& value, const std::map<std::string, Value>& choices,
                  const std::string& text) {
    add_choice_of(option, names_of(choices), text,
                  [&value, choices](const std::string& given) { value = choices.at(given); });
  }

  /// Adds --serial, which replaces the links that the program's other options name. For programs that create firmware
  /// and links separately.
  CLI::Option& add_serial();
  bool has_serial() const { return !serial_.empty(); }

  /// Reads the command line, then drives each robot of --robots by a firmware that `make` creates. `link_of` returns
  /// the link of the robot with this index among them. Returns the program's exit code.
  int run(int argc, char** argv, const std::function<std::unique_ptr<Firmware>()>& make,
          const std::function<std::string(std::size_t robot, std::size_t robots)>& link_of);

  /// Creates firmware and link of the robot with this index among those of --robots.
  using MakeDriver = std::function<Driver(const std::vector<std::string>& robots, std::size_t robot)>;
  int run(int argc, char** argv, const MakeDriver& make);
  /// Reads the command line, then calls `drive` with one client for all robots of --robots, which may be any selectors.
  /// Returns the program's exit code.
  int run(int argc, char** argv, const std::function<ClientEnd(const ClientOptions& client)>& drive);

 private:
  int run_to_exit_code(int argc, char** argv, const std::function<int()>& body);
  template <class Value>
  static std::vector<std::string> names_of(const std::map<std::string, Value>& choices) {
    std::vector<std::string> names;
    for (const auto& [name, value] : choices) names.push_back(name);
    return names;
  }
  void add_choice_of(const std::string& option, const std::vector<std::string>& names, const std::string& text,
                     const std::function<void(const std::string&)>& choose);

  std::string name_;
  std::string who_;
  CLI::App app_;
  ClientOptions client_;
  std::string robots_ = "0";
  std::vector<std::string> serial_;
  std::string command_;  // command of --run
  Patience patience_;
};

/// Splits a list of ids, ranges of ids and names into one selector for each robot. Throws UsageError.
std::vector<std::string> single_robots(const std::string& list);

}  // namespace cohort::bridges
