// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Files that a command writes at its end, and its standard output.
namespace cohort::tool {

class Log;

/// Checks before a long run that `file` can be written, and leaves no trace. Throws std::runtime_error with the reason
/// if it cannot. `what` names the contents in the message.
void check_writable(std::string_view what, const std::filesystem::path& file);

/// Replaces `file` atomically (AtomicFile). Throws std::runtime_error with the reason if it cannot.
void write_file(std::string_view what, const std::filesystem::path& file, std::string_view contents);

/// Flushes standard output. Returns `code`, or the exit code of a failure, which is logged, if the output could not be
/// written. A pipe whose reader has ended is not a failure.
int code_after_output(int code, Log& log);

}  // namespace cohort::tool
