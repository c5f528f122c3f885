// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace cohort {

/// Checks that a file is a controller plugin for this machine, with a version of the controller interface that this
/// program supports. Does not run any of its code. Throws std::runtime_error with the reason.
void check_plugin_file(const std::filesystem::path& file);

/// Throws std::runtime_error if this program does not support this version of the controller interface.
void check_plugin_abi(const std::filesystem::path& file, std::uint32_t abi);

}  // namespace cohort
