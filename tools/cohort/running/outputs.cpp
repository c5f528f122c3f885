#include "tools/cohort/running/outputs.hpp"

#include <string>
#include <utility>

#include "tools/cohort/cli/output_file.hpp"

namespace cohort::tool {

Outputs numbered(const Outputs& outputs, std::size_t number, std::size_t count) {
  Outputs numbered = outputs;
  if (count == 1) return numbered;
  for (std::filesystem::path* file : {&numbered.summary, &numbered.plot, &numbered.recording, &numbered.csv})
    if (!file->empty())
      *file = file->parent_path() / (file->stem().string() + "-" + std::to_string(number) + file->extension().string());
  return numbered;
}

void check_writable(const Outputs& outputs) {
  const std::pair<const char*, const std::filesystem::path&> files[] = {{"the summary", outputs.summary},
                                                                        {"the plot", outputs.plot},
                                                                        {"the recording", outputs.recording},
                                                                        {"the table", outputs.csv}};
  for (const auto& [what, file] : files)
    if (!file.empty()) check_writable(what, file);
}

}  // namespace cohort::tool
