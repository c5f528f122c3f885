// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Continuing as another program.
namespace cohort::tool {

/// Returns the words of this process's command line.
std::vector<std::string> own_words();

/// Returns the path that a program in the folder of this one has.
std::filesystem::path path_beside(const std::string& program);

/// Replaces this process with a program, which is looked for in PATH if its name has no slash. Returns the errno value
/// if this fails.
int become(const std::string& program, std::vector<std::string> words);

}  // namespace cohort::tool
