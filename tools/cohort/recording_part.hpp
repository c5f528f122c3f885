#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "server/recording/recording.hpp"

namespace cohort::tool {

inline std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

/// The robots that selectors select in a recording's first world; none for no selectors. Throws std::invalid_argument.
std::set<std::string> selected_names(const recording::Recording& recording, const std::vector<std::string>& selectors);

}  // namespace cohort::tool
