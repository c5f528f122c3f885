#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cohort {

/// The names that are most like one that does not exist, nearest first, at most `count`.
std::vector<std::string> nearest_names(std::string_view name, std::vector<std::string> names, std::size_t count);

}  // namespace cohort
