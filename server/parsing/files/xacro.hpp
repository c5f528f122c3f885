#pragma once

#include <filesystem>
#include <string>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// What the program `xacro`, of the virtual environment or else of the path, makes of a file. Throws std::runtime_error
/// that says what it complains of, or how to come by it.
std::string expand_xacro(const std::filesystem::path& file);

}  // namespace cohort::parsing
