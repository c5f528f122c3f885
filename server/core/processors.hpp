#pragma once

#include <filesystem>

namespace cohort {

/// How many threads may run at once: the cores that this process may run on, or fewer where a control group (of a
/// container, or of a systemd unit) has a quota of processor time; at least 1. Of a quota of 2.5 cores 2: a thread that
/// is stopped when the quota is used up keeps all others waiting. `root` is where /proc and /sys are.
unsigned available_processors(const std::filesystem::path& root = "/");

}  // namespace cohort
