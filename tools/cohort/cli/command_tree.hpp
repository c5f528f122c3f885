#pragma once

#include <string>
#include <vector>

#include "tools/cohort/cli/command_line.hpp"

/// The command lines that a program understands, as CLI11 was told of them: for shells' completion and the manual page.
namespace cohort::tool {

/// What stands for the value of an option or for an operand.
struct Placeholder {
  std::string text;                ///< such as FILE, N or above|side; empty: there is no value
  std::vector<std::string> words;  ///< that may be written as they are: above, side
  bool is_file() const;
  bool is_folder() const;
};

struct OptionLine {
  std::vector<std::string> names;  ///< with their dashes
  Placeholder value;
  std::string text;
  std::string variable;  ///< of the environment, which stands in for it; empty: none
};

struct OperandLine {
  std::string name;
  Placeholder value;
  std::string text;
  bool is_required = false;
  bool may_repeat = false;
};

struct CommandTree {
  std::string path;  ///< with the commands that it is part of: cohort ctl step
  std::string name;
  std::string text;
  std::string footer;
  std::vector<OptionLine> options;
  std::vector<OperandLine> operands;
  std::vector<CommandTree> commands;
};

/// Without what CLI11 was told to hide.
CommandTree command_tree(const CommandLine& line);

/// The command itself, then those below it, each before its own.
std::vector<const CommandTree*> all_commands(const CommandTree& root);

}  // namespace cohort::tool
