#include "tools/cohort/cli/usage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "client_sdk/src/domains.hpp"
#include "server/core/text.hpp"

namespace cohort::tool {
namespace {

bool is_above_zero(const std::string& text, double greatest) {
  const auto number = parse_real(text);
  return number && *number > 0.0 && *number <= greatest;
}

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
  const auto option =
      std::find_if(extras.begin(), extras.end(), [](const auto& text) { return text.starts_with('-'); });
  if (option != extras.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("there is no option '{}'{}", name, suggestion(name, options_of(command_of(app))));
  }
  if (extras.empty()) return fmt::format("expected a command; known: {}", fmt::join(commands_of(app), ", "));
  if (&command_of(app) == &app)
    return fmt::format("there is no command '{}'{}", extras.front(), suggestion(extras.front(), commands_of(app)));
  return fmt::format("unexpected '{}'", extras.front());
}

// The variable that an option's value came from, if the message is about one.
std::string origin(const CLI::App& command, const std::string& message) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_envname().empty() || !message.starts_with(option->get_name() + ":")) continue;
    if (const char* value = std::getenv(option->get_envname().c_str()); value != nullptr)
      return fmt::format(" ({} is '{}')", option->get_envname(), value);
  }
  return {};
}

}  // namespace

CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest) {
  return {[=](std::string& text) {
            const auto number = parse_whole(text);
            return number && *number >= least && *number <= greatest
                       ? std::string()
                       : fmt::format("expected a whole number from {} to {}, not '{}'", least, greatest, text);
          },
          ""};
}

CLI::Validator number_above_zero(double greatest) {
  return {[=](std::string& text) {
            return is_above_zero(text, greatest)
                       ? std::string()
                       : fmt::format("expected a number above 0 and up to {}, not '{}'", greatest, text);
          },
          ""};
}

CLI::Validator number_from_zero(double greatest) {
  return {[=](std::string& text) {
            const auto value = parse_real(text);
            return value && *value >= 0.0 && *value <= greatest
                       ? std::string()
                       : fmt::format("expected a number from 0 to {}, not '{}'", greatest, text);
          },
          ""};
}

CLI::Validator max_or_number_above_zero(double greatest) {
  return {[=](std::string& text) {
            return text == "max" || is_above_zero(text, greatest)
                       ? std::string()
                       : fmt::format("expected max, or a number above 0 and up to {}, not '{}'", greatest, text);
          },
          ""};
}

CLI::Validator domain_range() {
  return {[](std::string& text) -> std::string {
            try {
              parse_domains(text);
              return {};
            } catch (const std::invalid_argument& error) {
              return error.what();
            }
          },
          ""};
}

CLI::Validator one_of(std::vector<std::string> names) {
  return {[names = std::move(names)](std::string& text) {
            return std::find(names.begin(), names.end(), text) != names.end()
                       ? std::string()
                       : fmt::format("there is no '{}'{}", text, suggestion(text, names));
          },
          ""};
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = command_of(app);
  std::string message = error.what();
  switch (static_cast<CLI::ExitCodes>(error.get_exit_code())) {
    case CLI::ExitCodes::ExtrasError: message = unexpected(app); break;
    case CLI::ExitCodes::RequiredError:
      if (&command == &app) message = unexpected(app);
      break;
    case CLI::ExitCodes::ArgumentMismatch: message = message.substr(0, message.find(':')) + " needs a value"; break;
    default: message += origin(command, message);
  }
  if (!message.ends_with('?')) message += '.';
  return fmt::format("{} Try 'cohort {}--help'", message, &command == &app ? "" : command.get_name() + " ");
}

}  // namespace cohort::tool
