#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cohort::description {

/// Why a file that a person named cannot be read, such as "there is no such file"; nothing if it can.
std::optional<std::string> why_unreadable(const std::filesystem::path& file);

}  // namespace cohort::description
