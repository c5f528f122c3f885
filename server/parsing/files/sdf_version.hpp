#pragma once

#include <string_view>
#include <utility>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// "1.9" as {1, 9}; {0, 0} if it is anything else.
std::pair<int, int> version_of(std::string_view text);

}  // namespace cohort::parsing
