// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/cli/common/command_line.hpp"

/// The command lines that a program accepts, as declared to CLI11: for shell completion and the manual page.
namespace cohort::tool {

/// The placeholder of an option's value or of an operand.
struct Placeholder {
  std::string text;                ///< such as FILE, N or above|side; empty: no value
  std::vector<std::string> words;  ///< literal values, such as above and side
  bool is_file() const;
  bool is_folder() const;
};

struct OptionLine {
  std::vector<std::string> names;  ///< with their dashes
  Placeholder value;
  std::string text;
  std::string variable;  ///< environment variable with its default; empty: none
};

struct OperandLine {
  std::string name;
  Placeholder value;
  std::string text;
  bool is_required = false;
  bool may_repeat = false;
};

struct CommandTree {
  std::string path;  ///< including its parent commands, such as cohort ctl step
  std::string name;
  std::string text;
  std::string footer;
  std::vector<OptionLine> options;
  std::vector<OperandLine> operands;
  std::vector<CommandTree> commands;
};

/// Returns the tree of a command line, without hidden commands and options.
CommandTree command_tree(const CommandLine& line);

/// Returns the command and all its subcommands, in depth-first order.
std::vector<const CommandTree*> all_commands(const CommandTree& root);

}  // namespace cohort::tool
