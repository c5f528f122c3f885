#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Files that a command writes when it is done.
namespace cohort::tool {

/// Throws std::runtime_error that says why if `file` cannot be written: before a long run rather than after it. Leaves
/// no trace. `what` names the contents in the message.
void check_writable(std::string_view what, const std::filesystem::path& file);

/// Replaces `file` as a whole (AtomicFile). Throws std::runtime_error that says why it cannot.
void write_file(std::string_view what, const std::filesystem::path& file, std::string_view contents);

}  // namespace cohort::tool
