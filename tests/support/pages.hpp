// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/files.hpp"

/// Pages of the documentation, in Markdown.
namespace cohort::test {

/// Returns the items of the page's lists, each joined into one line. Items of nested lists belong to the outer item.
inline std::vector<std::string> list_items_of(const std::filesystem::path& page) {
  std::vector<std::string> items;
  for (const std::string& line : lines_of(read_file(page))) {
    if (line.starts_with("- "))
      items.push_back(line);
    else if (line.starts_with("  ") && !items.empty())
      items.back() += " " + line.substr(std::min(line.find_first_not_of(' '), line.size()));
  }
  return items;
}

}  // namespace cohort::test
