#pragma once

#include <filesystem>

namespace cohort::exec {

/// Returns the library that replaces the clocks of a program, as seen from the folder of the running program, in a
/// build tree as in an installation. Throws std::runtime_error if it is not there.
std::filesystem::path preload_library();

}  // namespace cohort::exec
