// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "idl/text/standard_streams.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/command_tree.hpp"

namespace cohort::tool {
namespace {

using Words = std::vector<std::string>;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

// Quotes a word for bash and zsh; fish escapes quotes differently.
std::string quoted(const std::string& text) { return "'" + replaced(text, "'", R"('\'')") + "'"; }
std::string quoted_for_fish(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

Words quoted(Words words) {
  std::ranges::transform(words, words.begin(), [](const std::string& word) { return quoted(word); });
  return words;
}

Words paths_below(const CommandTree& tree) {
  Words paths;
  for (const CommandTree* command : all_commands(tree))
    if (command != &tree) paths.push_back(command->path);
  return paths;
}

// Commands of a shell that complete a value.
struct Actions {
  std::string files;
  std::string folders;
  std::function<std::string(const Words&)> words;

  // Returns the command for a value; empty if its values are not known.
  std::string of(const Placeholder& value) const {
    if (value.is_file()) return files;
    if (value.is_folder()) return folders;
    return value.words.empty() ? ":" : words(value.words);
  }
};

// Returns the branches of a `case` on the command and the previous word, merged where they do the same.
std::string value_branches(const CommandTree& tree, const Actions& actions) {
  std::map<std::string, Words> patterns;
  for (const CommandTree* command : all_commands(tree))
    for (const OptionLine& option : command->options)
      for (const std::string& name : option.names)
        if (!option.value.text.empty()) patterns[actions.of(option.value)].push_back(command->path + " " + name);
  std::string text;
  for (const auto& [action, of] : patterns)
    text += fmt::format("    {})\n      {}\n      return ;;\n", fmt::join(quoted(of), "|"), action);
  return text;
}

// Returns the first operand that can be completed, which is used for all operands.
const Placeholder* operand_of(const CommandTree& command) {
  const auto found = std::ranges::find_if(command.operands, [](const OperandLine& operand) {
    return operand.value.is_file() || operand.value.is_folder() || !operand.value.words.empty();
  });
  return found == command.operands.end() ? nullptr : &found->value;
}

// The common part of bash and zsh: it finds the command that is being typed.
constexpr const char* find_command = R"(  for ((i = {first}; i < {current}; ++i)); do
    case "$command ${{{words}[i]}}" in
      {paths}) command+=" ${{{words}[i]}}" ;;
    esac
  done
)";

Words option_names(const CommandTree& command) {
  Words names;
  for (const OptionLine& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::string for_bash(const CommandTree& tree) {
  const Actions actions = {
      "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- \"$word\")",
      "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$word\")", [](const Words& words) {
        return fmt::format("mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\")", fmt::join(words, " "));
      }};
  std::string text = fmt::format("# Completion of {0} for bash, by '{0} completion bash'.\n_{0}() {{\n", tree.name);
  text += "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=" + tree.name + " i\n";
  text += fmt::format(find_command, fmt::arg("first", 1), fmt::arg("current", "COMP_CWORD"),
                      fmt::arg("words", "COMP_WORDS"),
                      fmt::arg("paths", fmt::to_string(fmt::join(quoted(paths_below(tree)), "|"))));
  text += "  COMPREPLY=()\n  case \"$command $before\" in\n" + value_branches(tree, actions) + "  esac\n";
  text += "  case \"$command\" in\n";
  for (const CommandTree* command : all_commands(tree)) {
    text += fmt::format("    {})\n      if [[ $word == -* ]]; then\n        {}\n", quoted(command->path),
                        actions.words(option_names(*command)));
    Words names;
    for (const CommandTree& each : command->commands) names.push_back(each.name);
    if (!names.empty())
      text += "      else\n        " + actions.words(names) + "\n";
    else if (const Placeholder* operand = operand_of(*command))
      text += "      else\n        " + actions.of(*operand) + "\n";
    text += "      fi ;;\n";
  }
  return text + fmt::format("  esac\n}}\ncomplete -F _{0} {0}\n", tree.name);
}

// Returns an entry of zsh's _describe: a word, a colon, and a description.
std::string described(const std::string& word, const std::string& text) {
  return quoted(replaced(word, ":", "\\:") + ":" + replaced(text, ":", "\\:"));
}

std::string zsh_list(const char* kind, const Words& items) {
  return fmt::format("list=({}); _describe {} list", fmt::join(items, " "), kind);
}

std::string for_zsh(const CommandTree& tree) {
  const Actions actions = {"_files", "_files -/",
                           [](const Words& words) { return fmt::format("compadd -- {}", fmt::join(words, " ")); }};
  std::string text =
      fmt::format("#compdef {0}\n# Completion of {0} for zsh, by '{0} completion zsh'.\n_{0}() {{\n", tree.name);
  text += "  local command=" + tree.name + " i\n  local -a list\n";
  text += fmt::format(find_command, fmt::arg("first", 2), fmt::arg("current", "CURRENT"), fmt::arg("words", "words"),
                      fmt::arg("paths", fmt::to_string(fmt::join(quoted(paths_below(tree)), "|"))));
  text += "  case \"$command ${words[CURRENT - 1]}\" in\n" + value_branches(tree, actions) + "  esac\n";
  text += "  case \"$command\" in\n";
  for (const CommandTree* command : all_commands(tree)) {
    Words options;
    for (const OptionLine& option : command->options)
      for (const std::string& name : option.names) options.push_back(described(name, option.text));
    text += fmt::format("    {})\n      if [[ ${{words[CURRENT]}} == -* ]]; then\n        {}\n", quoted(command->path),
                        zsh_list("option", options));
    Words names;
    for (const CommandTree& each : command->commands) names.push_back(described(each.name, each.text));
    if (!names.empty())
      text += "      else\n        " + zsh_list("command", names) + "\n";
    else if (const Placeholder* operand = operand_of(*command))
      text += "      else\n        " + actions.of(*operand) + "\n";
    text += "      fi ;;\n";
  }
  text += "  esac\n}\n";
  // The completion system reads the file as the function's body, which must already complete on the first call.
  return text + fmt::format("if [[ $funcstack[1] == _{0} ]]; then _{0} \"$@\"; else compdef _{0} {0}; fi\n", tree.name);
}

std::string fish_value(const Placeholder& value) {
  if (value.text.empty()) return "";
  if (value.is_file()) return " -r -F";
  if (value.is_folder()) return " -x -a '(__fish_complete_directories)'";
  return value.words.empty() ? " -x" : fmt::format(" -x -a '{}'", fmt::join(value.words, " "));
}

std::string for_fish(const CommandTree& tree) {
  std::string text = fmt::format(
      "# Completion of {0} for fish, by '{0} completion fish'.\n"
      "function __{0}_is_at\n"
      "  set -l command {0}\n"
      "  for word in (commandline -opc)[2..-1]\n"
      "    switch \"$command $word\"\n"
      "      case {1}\n"
      "        set command \"$command $word\"\n"
      "    end\n"
      "  end\n"
      "  test \"$command\" = \"$argv\"\n"
      "end\n"
      "complete -c {0} -f\n",
      tree.name, fmt::join(quoted(paths_below(tree)), " "));
  for (const CommandTree* command : all_commands(tree)) {
    const std::string here = fmt::format("complete -c {} -n '__{}_is_at {}'", tree.name, tree.name, command->path);
    for (const OptionLine& option : command->options) {
      std::string names;
      for (const std::string& name : option.names)
        names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      text += fmt::format("{}{}{} -d {}\n", here, names, fish_value(option.value), quoted_for_fish(option.text));
    }
    for (const CommandTree& each : command->commands)
      text += fmt::format("{} -a {} -d {}\n", here, each.name, quoted_for_fish(each.text));
    const Placeholder* operand = operand_of(*command);
    if (operand == nullptr) continue;
    if (operand->is_file())
      text += here + " -F\n";
    else if (operand->is_folder())
      text += here + " -a '(__fish_complete_directories)'\n";
    else
      text += fmt::format("{} -a '{}'\n", here, fmt::join(operand->words, " "));
  }
  return text;
}

const std::map<std::string, std::string (*)(const CommandTree&)> scripts = {
    {"bash", for_bash}, {"zsh", for_zsh}, {"fish", for_fish}};

}  // namespace

Subcommand add_completion(CommandLine app) {
  const auto shell = std::make_shared<std::string>();
  CommandLine line = app.add_subcommand(in_whole::completion.name, in_whole::completion.text);
  line.add_option("SHELL", *shell, "Shell that runs the script")
      .required()
      .check(one_of({"bash", "zsh", "fish"}))
      .type_name("bash|zsh|fish");
  line.footer("Example: source <(cohort completion bash)");
  return {line, [=](Log&, const std::atomic<bool>&) {
            write_output(scripts.at(*shell)(command_tree(app)));
            return exit_ok;
          }};
}

}  // namespace cohort::tool
