// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace cohort::exec {

/// Returns the library that replaces a program's clocks. It is found relative to the folder of the running program,
/// both in a build tree and in an installation. Throws std::runtime_error if it is missing.
std::filesystem::path preload_library();

}  // namespace cohort::exec
