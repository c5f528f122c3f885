// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "client_sdk/src/attachment.hpp"
#include "server/core/thread_room.hpp"
#include "server/description/shortened.hpp"
#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::debug: return spdlog::level::debug;
    case LogLevel::info: return spdlog::level::info;
    case LogLevel::warning: return spdlog::level::warn;
    case LogLevel::error: return spdlog::level::err;
    case LogLevel::off: break;
  }
  return spdlog::level::off;
}

std::shared_ptr<spdlog::logger> make_logger(LogFormat format, const std::string& text_pattern) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  auto logger = std::make_shared<spdlog::logger>("cohort", std::move(sink));
  if (format == LogFormat::json)
    logger->set_pattern(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})", spdlog::pattern_time_type::utc);
  else
    logger->set_pattern(text_pattern);
  return logger;
}

// Returns the members of a JSON line after time and level. Texts of files and controllers need not be UTF-8.
std::string json_members(const std::string& message, const LogFields& fields) {
  nlohmann::ordered_json object = {{"message", message}};
  for (const auto& [name, value] : fields) std::visit([&](const auto& held) { object[name] = held; }, value.get());
  const std::string text = json_text(object);
  return text.substr(1, text.size() - 2);
}

// Returns the text of a warning without the names in it, so that warnings of the same kind compare equal.
std::string kind_of(const description::Problem& warning) {
  std::string kind = warning.file.string() + ":";
  bool is_named = false;
  for (const char letter : warning.message) {
    if (letter == '\'') is_named = !is_named;
    if (!is_named && (letter < '0' || letter > '9')) kind += letter;
  }
  return kind;
}

}  // namespace

std::string text_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "there is not enough memory";
  const bool is_of_library = dynamic_cast<const std::system_error*>(&error) != nullptr;
  return is_of_library && is_thread_limit(error) ? ThreadLimit("a thread").what() : error.what();
}

LogLevel level_of(Severity severity) {
  switch (severity) {
    case Severity::info: return LogLevel::info;
    case Severity::warning: return LogLevel::warning;
    case Severity::error: break;
  }
  return LogLevel::error;
}

Log::Log(const LogOptions& options)
    : options_(options),
      rewrites_progress_(options.format == LogFormat::text && isatty(STDERR_FILENO) != 0),
      messages_(make_logger(options.format, "%^%n: %l:%$ %v")),
      lines_(make_logger(options.format, "%v")) {
  messages_->set_level(spdlog::level::debug);  // `write` and `urgent_warning` have their own limits
  lines_->set_level(spdlog::level::debug);
}

Log::~Log() { clear_progress(); }

void Log::write(LogLevel level, const std::string& message, const LogFields& fields) {
  if (shows(level)) print(*messages_, level, message, fields);
}

void Log::urgent_warning(const std::string& message, const LogFields& fields) {
  if (options_.level != LogLevel::off) print(*messages_, LogLevel::warning, message, fields);
}

void Log::problem(LogLevel level, const description::Problem& full) {
  if (!shows(level)) return;
  description::Problem problem = full;
  for (std::string* text : {&problem.element, &problem.message}) *text = description::shortened(std::move(*text));
  if (options_.format == LogFormat::json) {
    LogFields fields = {{"file", problem.file.string()}};
    if (problem.line > 0) fields.emplace_back("line", problem.line);
    if (!problem.element.empty()) fields.emplace_back("element", problem.element);
    print(*lines_, level, problem.message, fields);
    return;
  }
  if (level == LogLevel::warning) problem.element = problem.element.empty() ? "warning" : "warning: " + problem.element;
  print(*lines_, level, problem.text(), {});
}

void Log::problems(const description::InputError& error) {
  for (const description::Problem& each : error.problems()) problem(LogLevel::error, each);
}

void Log::warnings(const std::vector<description::Problem>& warnings) {
  const bool shows_all = options_.format == LogFormat::json || shows(LogLevel::info);
  std::map<std::string, std::size_t> counts;
  for (const description::Problem& each : warnings) ++counts[kind_of(each)];
  for (const description::Problem& each : warnings) {
    std::size_t& count = counts[kind_of(each)];
    if (shows_all) count = 1;
    if (count == 0) continue;  // a warning of this kind has been printed
    description::Problem first = each;
    if (count > 1) first.message += " (and " + std::to_string(count - 1) + " more like this: --verbose)";
    problem(LogLevel::warning, first);
    count = 0;
  }
}

void Log::notice(const std::string& message, const LogFields& fields) {
  if (options_.progress) print(*lines_, LogLevel::info, message, fields);
}

void Log::echo(const std::string& line, const LogFields& fields) {
  if (options_.format == LogFormat::json) {
    const auto object = nlohmann::json::parse(line, nullptr, false);
    const bool is_ours =
        object.is_object() && object.contains("time") && object.contains("level") && object.contains("message");
    if (!is_ours) return print(*lines_, LogLevel::info, line, fields);
  }
  const std::lock_guard lock(mutex_);
  clear_progress_line();
  std::fprintf(stderr, "%s\n", printable(line).c_str());
}

void Log::progress(const std::string& message, const LogFields& fields) {
  if (!options_.progress) return;
  if (!rewrites_progress_) return notice(message, fields);
  const std::lock_guard lock(mutex_);
  clear_progress_line();
  std::fputs(printable(message).c_str(), stderr);
  progress_line_open_ = true;
}

void Log::clear_progress() {
  const std::lock_guard lock(mutex_);
  clear_progress_line();
}

void Log::print(spdlog::logger& logger, LogLevel level, const std::string& message, const LogFields& fields) {
  const std::lock_guard lock(mutex_);
  clear_progress_line();
  logger.log(to_spdlog(level), options_.format == LogFormat::json ? json_members(message, fields)
                                                                  : printable(message, std::string::npos, Lines::kept));
}

void Log::clear_progress_line() {
  if (!progress_line_open_) return;
  std::fputs("\r\033[K", stderr);
  progress_line_open_ = false;
}

}  // namespace cohort::tool
