// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace cohort::tool {

/// Throws std::invalid_argument if `file` does not end in .svg, .png or .pdf, or std::runtime_error if the program that
/// draws such a file is missing.
void check_picture_file(const std::filesystem::path& file);

/// Writes a picture in the format that the file's extension says: an SVG document as it is, others by `rsvg-convert`.
/// Throws WriteError if it cannot.
void write_picture(const std::filesystem::path& file, const std::string& svg);

}  // namespace cohort::tool
