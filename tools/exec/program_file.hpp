// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace cohort::exec {

/// Returns the file that a command names. It is looked up in $PATH unless it contains a slash. Throws
/// std::runtime_error.
std::filesystem::path file_of_command(const std::string& command);

/// Returns a message to the user that says why a program's clocks cannot be replaced: it is linked statically, is built
/// for another machine, or is set-user-ID or set-group-ID. Empty if the file shows no such obstacle. For a script,
/// checks the interpreter.
std::string why_not_virtual(const std::filesystem::path& program);

}  // namespace cohort::exec
