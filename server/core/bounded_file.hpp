// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace cohort {

/// Returns the content of a file or a pipe. Throws std::runtime_error if it cannot be read, is longer than `most`
/// bytes, or is a device, which may have no end.
std::string read_bounded(const std::filesystem::path& file, std::size_t most);

}  // namespace cohort
