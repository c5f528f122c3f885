#include "tools/cohort/cli/installed_models.hpp"

#include <system_error>

namespace cohort::tool {

std::vector<std::filesystem::path> installed_model_folders() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const auto worlds = (program.parent_path() / COHORT_DATA_FROM_BIN / "cohort/worlds").lexically_normal();
  return {worlds / "robots", worlds / "objects"};
}

}  // namespace cohort::tool
