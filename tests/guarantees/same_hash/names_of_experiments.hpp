// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace cohort::test {

/// Returns the names of the experiments that ship, in alphabetical order.
inline std::vector<std::string> names_of_experiments() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(COHORT_SOURCE_DIR "/worlds/experiments"))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

}  // namespace cohort::test
