// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/command_tree.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

namespace cohort::tool {
namespace {

// Returns the fixed words of a placeholder: both for above|side, the first for max|X, none for N|A..B.
std::vector<std::string> words_of(const std::string& text) {
  if (text.find('|') == std::string::npos) return {};
  std::vector<std::string> words = CLI::detail::split(text, '|');
  std::erase_if(words, [](const std::string& word) {
    return word.empty() || !std::ranges::all_of(word, [](unsigned char c) { return std::islower(c) != 0 || c == '-'; });
  });
  return words;
}

Placeholder placeholder(const std::string& text) { return {text, words_of(text)}; }

OptionLine option_line(const CLI::Option& option) {
  OptionLine line;
  line.names.reserve(option.get_snames().size() + option.get_lnames().size());
  for (const std::string& name : option.get_snames()) line.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) line.names.push_back("--" + name);
  if (option.get_type_size() != 0) line.value = placeholder(option.get_type_name());
  line.text = option.get_description();
  line.variable = option.get_envname();
  return line;
}

OperandLine operand_line(const CLI::Option& option) {
  const std::string name = option.get_name(true);
  const std::string value = option.get_type_name();
  return {name, placeholder(value.empty() ? name : value), option.get_description(), option.get_required(),
          option.get_items_expected_max() > 1};
}

std::vector<const CLI::App*> parts_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* each) { return !each->get_group().empty(); });
}

void add_lines(const CLI::App& app, CommandTree& tree) {
  for (const CLI::Option* option : app.get_options()) {
    const bool is_told_before = app.get_name().empty() && option == app.get_help_ptr();
    if (is_told_before || option->get_group().empty()) continue;
    if (option->nonpositional())
      tree.options.push_back(option_line(*option));
    else
      tree.operands.push_back(operand_line(*option));
  }
  // CLI11 represents a group of alternative options as a command without a name.
  for (const CLI::App* part : parts_of(app))
    if (part->get_name().empty()) add_lines(*part, tree);
}

CommandTree tree_of(const CLI::App& app, const std::string& prefix) {
  CommandTree tree;
  tree.name = app.get_name();
  tree.path = prefix + tree.name;
  tree.text = app.get_description();
  tree.footer = app.get_footer();
  add_lines(app, tree);
  for (const CLI::App* part : parts_of(app))
    if (!part->get_name().empty()) tree.commands.push_back(tree_of(*part, tree.path + " "));
  return tree;
}

void add_commands(const CommandTree& tree, std::vector<const CommandTree*>& all) {
  all.push_back(&tree);
  for (const CommandTree& command : tree.commands) add_commands(command, all);
}

}  // namespace

bool Placeholder::is_file() const {
  return text.starts_with("FILE") || text == "FIRST" || text == "SECOND" || text == "MODEL" || text == "PLUGIN";
}

bool Placeholder::is_folder() const { return text == "DIR"; }

CommandTree command_tree(const CommandLine& line) { return tree_of(line.app(), ""); }

std::vector<const CommandTree*> all_commands(const CommandTree& root) {
  std::vector<const CommandTree*> all;
  add_commands(root, all);
  return all;
}

}  // namespace cohort::tool
