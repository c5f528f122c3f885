// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/preload_library.hpp"

#include <stdexcept>

namespace cohort::exec {

std::filesystem::path preload_library() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::filesystem::path library =
      (program.parent_path() / COHORT_LIBRARIES_FROM_BIN / "cohort" / "libcohort-exec.so").lexically_normal();
  if (!std::filesystem::exists(library))
    throw std::runtime_error("the library that replaces a program's clocks is missing: " + library.string());
  return library;
}

}  // namespace cohort::exec
