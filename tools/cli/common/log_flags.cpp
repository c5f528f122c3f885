// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/log_flags.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::tool {
namespace {

const std::vector<std::string> log_formats = {"text", "json"};
const std::vector<std::pair<std::string, LogLevel>> log_levels = {{"debug", LogLevel::debug},
                                                                  {"info", LogLevel::info},
                                                                  {"warn", LogLevel::warning},
                                                                  {"error", LogLevel::error},
                                                                  {"off", LogLevel::off}};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

LogLevel level_from_environment() {
  const std::string text = environment("COHORT_LOG");
  if (text.empty()) return LogLevel::warning;
  std::vector<std::string> names;
  for (const auto& [name, level] : log_levels) {
    if (name == text) return level;
    names.push_back(name);
  }
  throw UsageError("COHORT_LOG: invalid level '" + text + "'" + suggestion(text, names));
}

LogFormat log_format(std::string text) {
  if (text.empty()) text = environment("COHORT_LOG_FORMAT");
  if (text.empty() || text == "text") return LogFormat::text;
  if (text == "json") return LogFormat::json;
  throw UsageError("COHORT_LOG_FORMAT: invalid format '" + text + "'" + suggestion(text, log_formats));
}

}  // namespace

void add_log_flags(CommandLine line, LogFlags& flags) {
  line.add_option("--log-format", flags.format,
                  "Format of messages: text or json (default: $COHORT_LOG_FORMAT, or text)")
      .check(one_of(log_formats))
      .type_name("text|json");
  line.add_flag("--verbose", flags.verbose, "Also print informational messages; $COHORT_LOG selects other levels");
}

LogOptions log_options(const LogFlags& flags) {
  LogOptions options;
  options.format = log_format(flags.format);
  options.level = level_from_environment();
  if (flags.verbose && flags.quiet) throw UsageError("'--verbose' cannot be used with '--quiet'");
  if (flags.verbose) options.level = std::min(options.level, LogLevel::info);
  if (flags.quiet) options.level = std::max(options.level, LogLevel::error);
  options.progress = !flags.quiet && options.level != LogLevel::off;
  return options;
}

LogFormat format_of_unreadable(int argc, const char* const* argv) {
  bool is_json = environment("COHORT_LOG_FORMAT") == "json";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with("--log-format=")) is_json = argument.ends_with("=json");
    if (argument == "--log-format" && i + 1 < argc) is_json = std::string_view(argv[i + 1]) == "json";
  }
  return is_json ? LogFormat::json : LogFormat::text;
}

}  // namespace cohort::tool
