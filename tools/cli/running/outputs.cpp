// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/outputs.hpp"

#include <string>
#include <utility>

#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/picture_file.hpp"

namespace cohort::tool {

namespace {

std::filesystem::path with_number(const std::filesystem::path& file, std::size_t number) {
  if (file.empty()) return file;
  return file.parent_path() / (file.stem().string() + "-" + std::to_string(number) + file.extension().string());
}

}  // namespace

Outputs numbered(const Outputs& outputs, std::size_t number, std::size_t count) {
  Outputs numbered = outputs;
  if (count == 1) return numbered;
  for (std::filesystem::path* file : {&numbered.summary, &numbered.plot, &numbered.recording, &numbered.csv})
    *file = with_number(*file, number);
  return numbered;
}

Outputs numbered_by_seed(const Outputs& outputs, std::size_t number, std::size_t count) {
  Outputs one = numbered(outputs, number, count);
  one.csv = with_number(outputs.csv, number);
  return one;
}

void check_writable(const Outputs& outputs) {
  const std::pair<const char*, const std::filesystem::path&> files[] = {{"the summary", outputs.summary},
                                                                        {"the plot", outputs.plot},
                                                                        {"the recording", outputs.recording},
                                                                        {"the table", outputs.csv}};
  for (const auto& [what, file] : files)
    if (!file.empty()) check_writable(what, file);
  if (!outputs.plot.empty()) check_picture_file(outputs.plot);
}

}  // namespace cohort::tool
