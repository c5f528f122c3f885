#pragma once

#include <filesystem>
#include <string>

#include "server/parsing/files/xacro.hpp"

namespace cohort::tool {

/// Describes the model in a file, for people: its size, mass, channels with units and ranges, and the notes of the
/// file. The last line is the command line that runs the model, with `named`, the model as a person types it. Throws
/// InputError, and std::invalid_argument if the file holds no model.
std::string robot_sheet(const std::filesystem::path& file, const std::string& named, parsing::Xacro xacro);

}  // namespace cohort::tool
