// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cohort {

/// The folder of a control group (man 7 cgroups).
struct ControlGroup {
  bool is_version_2 = false;
  std::filesystem::path folder;
};

/// Returns the groups of this process that have the controller, such as `cpu`: its own group and the visible ancestors
/// of that group. `root`: folder with /proc and /sys.
std::vector<ControlGroup> control_groups(const std::string& controller, const std::filesystem::path& root = "/");

}  // namespace cohort
