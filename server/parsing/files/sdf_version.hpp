#pragma once

#include <string_view>
#include <utility>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// "1.9" as {1, 9}; {0, 0} if it is anything else.
std::pair<int, int> version_of(std::string_view text);

/// What is newer than libsdformat reads is made older, up to here.
inline constexpr std::pair<int, int> newest_version{1, 12};

}  // namespace cohort::parsing
