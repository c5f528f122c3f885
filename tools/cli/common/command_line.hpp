// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/cli/common/checks.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The part of CLI11 that the commands use, under CLI11's names, without its header, which takes seconds to compile.
namespace cohort::tool {

/// An error in a command line, described in one sentence.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option, an operand or a flag of a command line. Each member function returns the same option.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  Option check(Check check);
  /// Sets the placeholder of the value in help, such as FILE or above|side; empty for operands.
  Option type_name(const std::string& name);
  /// Sets the environment variable from which the option takes its default.
  Option envname(const std::string& variable);
  /// Shows the present value of the variable as the default in help.
  Option capture_default_str();
  /// Makes each occurrence of the option take one value.
  Option one_value();
  /// Makes the option take one value, whose parts are separated by commas.
  Option comma_separated();
  /// Calls `take` for each value. It may throw UsageError.
  Option each(std::function<void(const std::string&)> take);
  Option needs(Option other);
  Option excludes(Option other);
  /// Hides the option from help.
  Option hide();

 private:
  CLI::Option* option_;
};

/// The command line of a program, or of one of its commands. All copies refer to the same one. The variables that its
/// options write must outlive it.
class CommandLine {
 public:
  CommandLine(const std::string& text, const std::string& name);

  /// Adds an option. `name` is, for example, `--seed`, `-o,--output`, or `FILE` for an operand. A value is a string, a
  /// path, a number, an optional number, or a vector: command_line.cpp lists the types.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& text = {});
  /// Adds an option whose value is passed to `take`, which may throw UsageError. A value is a string, a double or a
  /// std::uint64_t.
  template <class Value>
  Option add_option_function(const std::string& name, std::function<void(const Value&)> take, const std::string& text);
  /// Adds a flag. A `name` that ends in `{false}` sets `value` to false.
  Option add_flag(const std::string& name, bool& value, const std::string& text = {});

  CommandLine add_subcommand(const std::string& name, const std::string& text);
  /// Adds a group of options of which exactly one is required.
  CommandLine add_alternatives(const std::string& name);
  void set_version(std::function<std::string()> version, const std::string& text);
  void set_help(const std::string& text);
  void footer(const std::string& text);
  void require_subcommand();
  /// Makes subcommands accept the options of this command too.
  void fallthrough();
  /// Sets a function that is called when this command is parsed.
  void callback(std::function<void()> parsed);
  /// Hides the command from help.
  void hide();
  /// Leaves all following arguments, including `--help`, to another program.
  void take_all();

  /// Parses the command line. Returns false if help or the version was requested and has been printed. Throws
  /// UsageError, which suggests the nearest known name and the help to read.
  bool parse(int argc, const char* const* argv);
  /// Returns whether this command was given on the command line.
  bool parsed() const;

  const CLI::App& app() const { return *app_; }

 private:
  explicit CommandLine(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}

  std::shared_ptr<CLI::App> app_;  // a subcommand's pointer owns the whole program's
};

}  // namespace cohort::tool
