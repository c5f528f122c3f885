// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace cohort {

/// Returns how many threads may run at once, at least 1: the cores available to this process, or fewer if a control
/// group limits the processor time (container, systemd unit). A quota of 2.5 cores gives 2, as a thread that is stopped
/// by the quota delays all others. `root`: folder with /proc and /sys.
unsigned available_processors(const std::filesystem::path& root = "/");

}  // namespace cohort
