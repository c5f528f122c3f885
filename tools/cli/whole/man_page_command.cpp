// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>

#include "idl/include/cohort/version.h"
#include "idl/text/standard_streams.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/command_tree.hpp"

namespace cohort::tool {
namespace {

// Escapes characters that roff would read as a command or a typographic mark.
std::string plain(const std::string& text) {
  std::string written;
  written.reserve(text.size());
  for (const char c : text) {
    if (c == '\n') written += "\n.br";
    if ((c == '.' || c == '\'') && (written.empty() || written.back() == '\n')) written += "\\&";
    if (c == '\\')
      written += "\\e";
    else if (c == '-')
      written += "\\-";
    else if (c == '\'')
      written += "\\(aq";
    else
      written += c;
  }
  return written;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

std::string value_of(const Placeholder& value) {
  if (value.text.empty()) return "";
  return " " + (value.words.empty() ? italic(value.text) : plain(value.text));
}

std::string usage_of(const CommandTree& command) {
  std::string usage = bold(command.path);
  if (!command.options.empty()) usage += " [" + italic("OPTIONS") + "]";
  for (const OperandLine& operand : command.operands) {
    const std::string name = italic(operand.name) + (operand.may_repeat ? " ..." : "");
    usage += operand.is_required ? " " + name : " [" + name + "]";
  }
  if (!command.commands.empty()) usage += " " + italic("COMMAND");
  return usage;
}

std::string options_of(const CommandTree& command) {
  std::string text;
  for (const OptionLine& option : command.options) {
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
    text += fmt::format(".TP\n{}{}\n{}\n", names, value_of(option.value), plain(option.text));
  }
  return text;
}

std::string section_of(const CommandTree& command) {
  std::string text = fmt::format(".SS {}\n{}.\n", usage_of(command), plain(command.text));
  for (const OperandLine& operand : command.operands)
    text += fmt::format(".TP\n{}\n{}\n", italic(operand.name), plain(operand.text));
  text += options_of(command);
  if (!command.footer.empty()) text += ".PP\n" + plain(command.footer) + "\n";
  return text;
}

std::string environment_of(const CommandTree& tree) {
  std::map<std::string, std::string> options;
  for (const CommandTree* command : all_commands(tree))
    for (const OptionLine& option : command->options)
      if (!option.variable.empty()) options[option.variable] = option.names.back();
  std::string text;
  for (const auto& [variable, option] : options)
    text += fmt::format(".TP\n{}\nDefault value of {}.\n", bold(variable), bold(option));
  return text;
}

std::string man_page(const CommandTree& tree) {
  const std::size_t colon = tree.text.find(": ");
  std::string text = fmt::format(
      ".TH COHORT 1 \"\" \"Cohort {}\" \"User Commands\"\n"
      ".nh\n.ad l\n"
      ".SH NAME\n{} \\- {}\n"
      ".SH SYNOPSIS\n{}\n"
      ".SH DESCRIPTION\n{}\n.PP\n{}\n"
      ".SH OPTIONS\n{}"
      ".SH COMMANDS\n",
      COHORT_VERSION, tree.name, plain(colon == std::string::npos ? tree.text : tree.text.substr(colon + 2)),
      usage_of(tree), plain(tree.text + "."), plain(tree.footer), options_of(tree));
  for (const CommandTree* command : all_commands(tree))
    if (command != &tree) text += section_of(*command);
  return text + ".SH ENVIRONMENT\n" + environment_of(tree) +
         ".SH SEE ALSO\nThe documents in share/doc/cohort: docs/cli.md describes the commands in detail.\n";
}

}  // namespace

Subcommand add_man_page(CommandLine app) {
  CommandLine line = app.add_subcommand(in_whole::man_page.name, in_whole::man_page.text);
  line.footer("Example: cohort man-page | man -l -");
  return {line, [app](Log&, const std::atomic<bool>&) {
            write_output(man_page(command_tree(app)));
            return exit_ok;
          }};
}

}  // namespace cohort::tool
