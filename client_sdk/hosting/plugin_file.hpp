#pragma once

#include <cstdint>
#include <filesystem>

namespace cohort {

/// Checks, without running any of its code, that a file is a controller plugin for this machine and of a version of the
/// controller interface that this program takes. Throws std::runtime_error that says what is wrong with it.
void check_plugin_file(const std::filesystem::path& file);

/// Throws std::runtime_error if this program does not take plugins of that version of the controller interface.
void check_plugin_abi(const std::filesystem::path& file, std::uint32_t abi);

}  // namespace cohort
