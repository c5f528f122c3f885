#include "tools/cohort/cli/installed_files.hpp"

#include <system_error>

namespace cohort::tool {
namespace {

std::filesystem::path installed(const char* folder) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  return (program.parent_path() / COHORT_DATA_FROM_BIN / "cohort" / folder).lexically_normal();
}

}  // namespace

std::vector<std::filesystem::path> installed_model_folders() {
  const std::filesystem::path worlds = installed("worlds");
  if (worlds.empty()) return {};
  return {worlds / "robots", worlds / "objects"};
}

std::filesystem::path installed_page_folder() { return installed("view"); }

}  // namespace cohort::tool
