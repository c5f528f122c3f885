#pragma once

#include <filesystem>
#include <string>

namespace cohort::exec {

/// Returns the file that a command names: of $PATH, unless it has a slash. Throws std::runtime_error.
std::filesystem::path file_of_command(const std::string& command);

/// Returns why the clocks of a program cannot be replaced, for people: because it is linked statically, belongs to
/// another machine, or takes another user's rights. Empty if they can be, as far as its file tells. For a script, the
/// interpreter is checked.
std::string why_not_virtual(const std::filesystem::path& program);

}  // namespace cohort::exec
