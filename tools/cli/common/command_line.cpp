// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "idl/text/standard_streams.hpp"
#include "server/core/text.hpp"

namespace cohort::tool {
namespace {

const CLI::App& command_of(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (!option->get_group().empty()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string unexpected(const CLI::App& app) {
  const std::vector<std::string> extras = app.remaining(true);
  const CLI::App& command = command_of(app);
  const std::vector<std::string> commands = commands_of(command);
  // An unknown command's options are unknown too.
  const bool is_of_command = command.get_subcommands().empty() && !commands.empty() && !extras.empty();
  if (is_of_command && !extras.front().starts_with('-'))
    return fmt::format("there is no command '{}'{}", extras.front(), suggestion(extras.front(), commands));
  const auto option =
      std::find_if(extras.begin(), extras.end(), [](const auto& text) { return text.starts_with('-'); });
  if (option != extras.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("there is no option '{}'{}", name, suggestion(name, options_of(command)));
  }
  if (extras.empty()) return fmt::format("expected a command; known: {}", fmt::join(commands, ", "));
  if (!commands.empty())
    return fmt::format("there is no command '{}'{}", extras.front(), suggestion(extras.front(), commands));
  return fmt::format("unexpected '{}'", extras.front());
}

// Returns the environment variable that an option's value came from, if the message is about such an option.
std::string origin(const CLI::App& command, const std::string& message) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_envname().empty() || !message.starts_with(option->get_name() + ":")) continue;
    if (const char* value = std::getenv(option->get_envname().c_str()); value != nullptr)
      return fmt::format(" ({} is '{}')", option->get_envname(), value);
  }
  return {};
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = command_of(app);
  std::string message = error.what();
  switch (static_cast<CLI::ExitCodes>(error.get_exit_code())) {
    case CLI::ExitCodes::ExtrasError: message = unexpected(app); break;
    case CLI::ExitCodes::RequiredError:
      if (command.get_require_subcommand_min() > 0 && command.get_subcommands().empty()) message = unexpected(app);
      break;
    case CLI::ExitCodes::ArgumentMismatch: message = message.substr(0, message.find(':')) + " needs a value"; break;
    case CLI::ExitCodes::ExcludesError:
      if (const std::size_t verb = message.find(" excludes "); verb != std::string::npos)
        message = fmt::format("'{}' cannot be used with '{}'", message.substr(0, verb), message.substr(verb + 10));
      break;
    default: message += origin(command, message);
  }
  if (!message.ends_with('?')) message += '.';
  return fmt::format("{} Try 'cohort {}--help'", message, &command == &app ? "" : command.get_name() + " ");
}

// CLI11 reports only errors of its own types.
template <class Value>
std::function<void(const Value&)> with_errors_of_cli11(std::function<void(const Value&)> take) {
  return [take = std::move(take)](const Value& value) {
    try {
      take(value);
    } catch (const UsageError& error) {
      throw CLI::ValidationError(error.what());
    }
  };
}

}  // namespace

Option Option::required() { return Option(option_->required()); }
Option Option::type_name(const std::string& name) { return Option(option_->type_name(name)); }
Option Option::envname(const std::string& variable) { return Option(option_->envname(variable)); }
Option Option::capture_default_str() { return Option(option_->capture_default_str()); }
Option Option::one_value() { return Option(option_->allow_extra_args(false)); }
Option Option::comma_separated() { return Option(option_->delimiter(',')->allow_extra_args(false)); }
Option Option::needs(Option other) { return Option(option_->needs(other.option_)); }
Option Option::excludes(Option other) { return Option(option_->excludes(other.option_)); }
Option Option::hide() { return Option(option_->group("")); }

Option Option::check(Check check) {
  return Option(
      option_->check(CLI::Validator([check = std::move(check)](std::string& value) { return check(value); }, "")));
}

Option Option::each(std::function<void(const std::string&)> take) {
  return Option(option_->each(with_errors_of_cli11(std::move(take))));
}

CommandLine::CommandLine(const std::string& text, const std::string& name)
    : app_(std::make_shared<CLI::App>(text, name)) {}

template <class Value>
Option CommandLine::add_option(const std::string& name, Value& value, const std::string& text) {
  return Option(app_->add_option(name, value, text));
}
template Option CommandLine::add_option(const std::string&, std::string&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option CommandLine::add_option(const std::string&, double&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::uint16_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::uint32_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::optional<std::uint16_t>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<std::uint32_t>&, const std::string&);

template <class Value>
Option CommandLine::add_option_function(const std::string& name, std::function<void(const Value&)> take,
                                        const std::string& text) {
  return Option(app_->add_option_function<Value>(name, with_errors_of_cli11(std::move(take)), text));
}
template Option CommandLine::add_option_function(const std::string&, std::function<void(const std::string&)>,
                                                 const std::string&);
template Option CommandLine::add_option_function(const std::string&, std::function<void(const double&)>,
                                                 const std::string&);
template Option CommandLine::add_option_function(const std::string&, std::function<void(const std::uint64_t&)>,
                                                 const std::string&);

Option CommandLine::add_flag(const std::string& name, bool& value, const std::string& text) {
  return Option(app_->add_flag(name, value, text));
}

CommandLine CommandLine::add_subcommand(const std::string& name, const std::string& text) {
  return CommandLine({app_, app_->add_subcommand(name, text)});
}

CommandLine CommandLine::add_alternatives(const std::string& name) {
  CLI::App* const group = app_->add_option_group(name);
  group->require_option(1);
  return CommandLine({app_, group});
}

void CommandLine::set_version(std::function<std::string()> version, const std::string& text) {
  app_->set_version_flag("--version", std::move(version), text);
}

void CommandLine::set_help(const std::string& text) { app_->set_help_flag("-h,--help", text); }
void CommandLine::footer(const std::string& text) { app_->footer(text); }
void CommandLine::require_subcommand() { app_->require_subcommand(1); }
void CommandLine::fallthrough() { app_->fallthrough(); }
void CommandLine::callback(std::function<void()> parsed) { app_->callback(std::move(parsed)); }
void CommandLine::hide() { app_->group(""); }

void CommandLine::take_all() {
  app_->set_help_flag();
  app_->prefix_command();
}

bool CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    app_->exit(help, text, text);
    write_output(text.str());
    return false;
  } catch (const CLI::ParseError& error) {
    throw UsageError(usage_error(*app_, error));
  }
}

bool CommandLine::parsed() const { return app_->parsed(); }

}  // namespace cohort::tool
