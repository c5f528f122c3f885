// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cohort {

/// Returns at most `count` of the names, the most similar to `name` first.
std::vector<std::string> nearest_names(std::string_view name, std::vector<std::string> names, std::size_t count);

}  // namespace cohort
