// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Permission for the program `xacro` to expand the file that the user names. It evaluates Python code in the file, so
/// it runs only for that file; files that it includes or names are never expanded.
enum class Xacro { refused, run };

/// Returns the first element that only `xacro` understands; nullptr if there is none. `file` is the file of the
/// document.
const XmlNode* find_macro(const XmlNode& root, const std::filesystem::path& file);

/// Returns the message for a file with macros that may not be expanded.
std::string why_not_expanded(const std::filesystem::path& file);

/// Expands `file`, which the user has named and trusts: its content in `input` becomes the output of `xacro`, from the
/// virtual environment or else from the path. Does nothing to a file without macros. Throws InputError with the message
/// of xacro.
void expand_named(InputFiles& input, const std::filesystem::path& file);

}  // namespace cohort::parsing
