#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/cohort/cli/checks.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// What of CLI11 the commands use, under CLI11's names, without its header, which takes seconds to compile.
namespace cohort::tool {

/// A mistake in a command line, in one sentence.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option, an operand or a flag of a command line. Each call returns the same one.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  Option check(Check check);
  /// What stands for the value in help, such as FILE or above|side; empty for operands.
  Option type_name(const std::string& name);
  /// Variable of the environment that stands in for it.
  Option envname(const std::string& variable);
  /// Help tells the value that the variable has now.
  Option capture_default_str();
  /// Each time that it is given it takes one value.
  Option one_value();
  /// One value, with commas between its parts.
  Option comma_separated();
  /// Calls `take` for each value. It may throw UsageError.
  Option each(std::function<void(const std::string&)> take);
  Option needs(Option other);
  Option excludes(Option other);
  /// In no help.
  Option hide();

 private:
  CLI::Option* option_;
};

/// The command line of a program, or of a command of it; all copies are the same one. What its options fill in has to
/// outlive it.
class CommandLine {
 public:
  CommandLine(const std::string& text, const std::string& name);

  /// `name`: such as `--seed`, `-o,--output`, or `FILE` for an operand. Values are strings, paths, numbers, optional
  /// ones, and vectors of them: those that command_line.cpp lists.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& text = {});
  /// The same, with what is done with the value, which may throw UsageError. Values are strings, doubles and
  /// std::uint64_t.
  template <class Value>
  Option add_option_function(const std::string& name, std::function<void(const Value&)> take, const std::string& text);
  /// A `name` that ends in `{false}` makes it false.
  Option add_flag(const std::string& name, bool& value, const std::string& text = {});

  CommandLine add_subcommand(const std::string& name, const std::string& text);
  /// For options of which exactly one is required.
  CommandLine add_alternatives(const std::string& name);
  void set_version(std::function<std::string()> version, const std::string& text);
  void set_help(const std::string& text);
  void footer(const std::string& text);
  void require_subcommand();
  /// Subcommands take its options too.
  void fallthrough();
  /// Called when this command is parsed.
  void callback(std::function<void()> parsed);
  /// In no help.
  void hide();
  /// Whatever follows is for another program to understand, `--help` too.
  void take_all();

  /// False if help or the version was asked for, which is then printed. Throws UsageError with the nearest known name,
  /// and which help to ask for.
  bool parse(int argc, const char* const* argv);
  /// Whether this command was asked for.
  bool parsed() const;

  const CLI::App& app() const { return *app_; }

 private:
  explicit CommandLine(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}

  std::shared_ptr<CLI::App> app_;  // of a subcommand: owns the whole program's
};

}  // namespace cohort::tool
