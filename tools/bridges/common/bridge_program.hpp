#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/bridges/common/firmware.hpp"

namespace cohort::bridges {

/// A mistake in the options of a bridge.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command line of a bridge's program: the options that all bridges have, to which each adds its own.
class BridgeProgram {
 public:
  /// `name`: of the program. `who`: what people call what drives a robot.
  BridgeProgram(std::string name, std::string who, const std::string& text);

  CLI::App& app() { return app_; }
  Patience& patience() { return patience_; }

  /// Adds an option whose value is one of `choices`.
  template <class Value>
  void add_choice(const std::string& option, Value& value, const std::map<std::string, Value>& choices,
                  const std::string& text) {
    add_choice_of(option, names_of(choices), text,
                  [&value, choices](const std::string& given) { value = choices.at(given); });
  }

  /// Reads the command line, then drives each robot by a firmware that `make` gives, over the link that `link_of`
  /// names for the robot's place among those of --robots. Returns the program's exit code.
  int run(int argc, char** argv, const std::function<std::unique_ptr<Firmware>()>& make,
          const std::function<std::string(std::size_t robot, std::size_t robots)>& link_of);

 private:
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
  Patience patience_;
};

/// Splits a list of selectors into one for each robot: ids, ranges of ids and names. Throws UsageError.
std::vector<std::string> single_robots(const std::string& list);

}  // namespace cohort::bridges
