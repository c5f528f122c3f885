#include "tools/cohort/cli/installed_page.hpp"

#include <system_error>

namespace cohort::tool {

std::filesystem::path installed_page_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  return (program.parent_path() / COHORT_DATA_FROM_BIN / "cohort/view").lexically_normal();
}

}  // namespace cohort::tool
