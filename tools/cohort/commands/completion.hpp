#pragma once

#include <string>

#include "tools/cohort/cli/command_tree.hpp"

namespace cohort::tool {

enum class Shell { bash, zsh, fish };

/// A script for the shell that completes commands, options and their values.
std::string completion(const CommandTree& tree, Shell shell);

}  // namespace cohort::tool
