// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <iostream>

#include "tests/figures/figures.hpp"
#include "tools/cli/common/output_file.hpp"

// Draws how the devices of an s-bot respond, a file for each group of them.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: cohort_figures FOLDER\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    for (const cohort::figures::Page& page : cohort::figures::all_pages())
      cohort::tool::write_file("a figure", folder / (page.name + ".svg"), cohort::figures::draw(page));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "cohort_figures: " << error.what() << '\n';
    return 1;
  }
}
