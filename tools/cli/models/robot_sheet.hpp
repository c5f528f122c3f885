// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "server/parsing/files/xacro.hpp"

namespace cohort::tool {

/// Returns a description of the model in a file for the user: its size, mass, channels with units and ranges, and the
/// notes of the file. The last line is the command line that runs the model, with `named`, the model's name as the user
/// typed it. Throws InputError, and std::invalid_argument if the file contains no model.
std::string robot_sheet(const std::filesystem::path& file, const std::string& named, parsing::Xacro xacro);

}  // namespace cohort::tool
