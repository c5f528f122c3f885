// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/refuse_experiment.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "server/parsing/sdf/file_kind.hpp"
#include "tools/cli/common/installed_files.hpp"

namespace cohort::tool {
namespace {

constexpr std::array<std::string_view, 6> extensions = {".yaml", ".yml", ".sdf", ".world", ".urdf", ".xacro"};

// Null if it is none of them.
const char* kind_of(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::exists(file, none)) {
    if (std::ranges::count(installed_experiments(), file.string()) > 0) return "an experiment";
    return installed_model(file.string()) ? "a model" : nullptr;
  }
  if (std::ranges::count(extensions, file.extension().string()) == 0) return nullptr;
  return parsing::kind_of_file(file) == parsing::FileKind::sdf ? "a world or a model" : "an experiment";
}

}  // namespace

void refuse_experiment(const std::filesystem::path& file, const std::string& option) {
  const char* const kind = kind_of(file);
  if (kind != nullptr)
    throw std::invalid_argument(file.string() + " is " + kind + ", not a recording. To run it: cohort run " +
                                file.string() + " " + option);
}

}  // namespace cohort::tool
