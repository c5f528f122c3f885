// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Returns a version of SDF such as "1.9" as {1, 9}; {0, 0} for any other text.
std::pair<int, int> version_of(std::string_view text);

/// The version to which files of other versions are converted.
inline constexpr std::string_view converted_version = "1.9";

/// The newest version that is read.
inline constexpr std::pair<int, int> newest_version{1, 12};

}  // namespace cohort::parsing
