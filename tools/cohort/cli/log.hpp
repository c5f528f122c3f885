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

/// What it says, in words for people also if memory is what lacks.
std::string text_of(const std::exception& error);

/// The level of what a client tells.
LogLevel level_of(Severity severity);

struct LogOptions {
  LogFormat format = LogFormat::text;
  LogLevel level = LogLevel::warning;  ///< the least that is printed
  bool progress = true;                ///< print progress and notices, which have no level
};

/// A value of a field: a number, a text, or texts.
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

/// What a message is about, for machines: printed in JSON only.
using LogFields = std::vector<std::pair<std::string, LogValue>>;

/// All that a command has to say on standard error: as text for people, or as JSON, an object on each line with `time`,
/// `level`, `message` and fields. Any thread may call it; a line is never torn apart.
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

  /// In text as compilers do, so that editors find the place: `FILE:LINE: ELEMENT: MESSAGE`.
  void problem(LogLevel level, const description::Problem& problem);
  void problems(const description::InputError& error);
  /// Warnings of a file: the first of each kind, with how many more there are; in JSON and at the level `info` all of
  /// them.
  void warnings(const std::vector<description::Problem>& warnings);

  /// What people wait for, such as that the server is there. In text without a prefix.
  void notice(const std::string& message, const LogFields& fields = {});
  /// The same, and the next one takes its place if `rewrites_progress`.
  void progress(const std::string& message, const LogFields& fields = {});
  bool rewrites_progress() const { return rewrites_progress_; }
  /// What another program printed, line by line: as it is if it is one of our lines.
  void echo(const std::string& line, const LogFields& fields);
  /// Before something else is printed to the terminal.
  void clear_progress();

 private:
  void print(spdlog::logger& logger, LogLevel level, const std::string& message, const LogFields& fields);
  void clear_progress_line();

  const LogOptions options_;
  const bool rewrites_progress_;
  std::mutex mutex_;
  bool progress_line_open_ = false;
  std::shared_ptr<spdlog::logger> messages_;
  std::shared_ptr<spdlog::logger> lines_;  // in text without a prefix
};

}  // namespace cohort::tool
