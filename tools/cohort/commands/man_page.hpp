#pragma once

#include <string>

#include "tools/cohort/cli/command_tree.hpp"

namespace cohort::tool {

/// A page of section 1 for `man`, in roff.
std::string man_page(const CommandTree& tree);

}  // namespace cohort::tool
