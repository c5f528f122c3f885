// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/description/input_error.hpp"

namespace spdlog {
class logger;
}
namespace cohort {
enum class Severity;  // client_sdk/src/attachment.hpp
}

namespace cohort::tool {

enum class LogFormat { text, json };
enum class LogLevel { debug, info, warning, error, off };

/// Returns the message of an exception. Explains a lack of memory, and a limit of threads.
std::string text_of(const std::exception& error);

/// Returns the level for a client's message of this severity.
LogLevel level_of(Severity severity);

struct LogOptions {
  LogFormat format = LogFormat::text;
  LogLevel level = LogLevel::warning;  ///< least severe level that is printed
  bool progress = true;                ///< print progress and notices, which have no level
};

/// The value of a field: a number, a text, or several texts.
class LogValue {
 public:
  LogValue(std::integral auto value) : value_(std::int64_t{value}) {}
  LogValue(std::uint64_t value) : value_(value) {}
  LogValue(double value) : value_(value) {}
  LogValue(const char* value) : value_(std::string(value)) {}
  LogValue(std::string value) : value_(std::move(value)) {}
  LogValue(std::vector<std::string> value) : value_(std::move(value)) {}

  const auto& get() const { return value_; }

 private:
  std::variant<std::int64_t, std::uint64_t, double, std::string, std::vector<std::string>> value_;
};

/// Machine-readable fields of a message, printed in JSON only.
using LogFields = std::vector<std::pair<std::string, LogValue>>;

/// The messages of a command on standard error: as text, or as JSON with one object per line, which has `time`,
/// `level`, `message` and fields. Any thread may call it; lines are written whole.
class Log {
 public:
  explicit Log(const LogOptions& options);
  ~Log();

  LogFormat format() const { return options_.format; }
  bool shows(LogLevel level) const { return level >= options_.level; }

  void write(LogLevel level, const std::string& message, const LogFields& fields = {});
  void debug(const std::string& message, const LogFields& fields = {}) { write(LogLevel::debug, message, fields); }
  void info(const std::string& message, const LogFields& fields = {}) { write(LogLevel::info, message, fields); }
  void warning(const std::string& message, const LogFields& fields = {}) { write(LogLevel::warning, message, fields); }
  void error(const std::string& message, const LogFields& fields = {}) { write(LogLevel::error, message, fields); }

  /// Prints a warning also with --quiet, for when the program would seem to do nothing.
  void urgent_warning(const std::string& message, const LogFields& fields = {});

  /// Prints a problem. Text has the format of compilers, so that editors find the place: `FILE:LINE: ELEMENT: MESSAGE`.
  void problem(LogLevel level, const description::Problem& problem);
  void problems(const description::InputError& error);
  /// Prints the warnings of a file: the first of each kind, with the number of the others. In JSON and at the level
  /// `info`, prints all of them.
  void warnings(const std::vector<description::Problem>& warnings);

  /// Prints a message that users wait for, such as that the server is ready. Text has no prefix.
  void notice(const std::string& message, const LogFields& fields = {});
  /// Prints a notice that the next one overwrites if `rewrites_progress`.
  void progress(const std::string& message, const LogFields& fields = {});
  bool rewrites_progress() const { return rewrites_progress_; }
  /// Prints a line of another program's output, unchanged if it already has the format of this log.
  void echo(const std::string& line, const LogFields& fields);
  /// Clears the progress line before other output to the terminal.
  void clear_progress();

 private:
  void print(spdlog::logger& logger, LogLevel level, const std::string& message, const LogFields& fields);
  void clear_progress_line();

  const LogOptions options_;
  const bool rewrites_progress_;
  std::mutex mutex_;
  bool progress_line_open_ = false;
  std::shared_ptr<spdlog::logger> messages_;
  std::shared_ptr<spdlog::logger> lines_;  // logger of lines without a prefix in text
};

}  // namespace cohort::tool
