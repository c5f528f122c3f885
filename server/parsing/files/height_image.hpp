// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/description/shape.hpp"
#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

/// Reads heights from a grey PNG image: one for each pixel; black is 0 and white is `size.z()`. The image covers
/// `size.x()` by `size.y()`, with its upper edge towards +y. Throws std::runtime_error with the problem of the file.
HeightGrid read_height_image(InputFiles& input, const std::filesystem::path& file, const Eigen::Vector3d& size);

}  // namespace cohort::parsing
