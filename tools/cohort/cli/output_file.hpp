#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Files that a command writes at its end.
namespace cohort::tool {

/// Checks before a long run that `file` can be written, and leaves no trace. Throws std::runtime_error with the reason
/// if it cannot. `what` names the contents in the message.
void check_writable(std::string_view what, const std::filesystem::path& file);

/// Replaces `file` atomically (AtomicFile). Throws std::runtime_error with the reason if it cannot.
void write_file(std::string_view what, const std::filesystem::path& file, std::string_view contents);

}  // namespace cohort::tool
