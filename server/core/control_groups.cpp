// SPDX-License-Identifier: Apache-2.0
#include "server/core/control_groups.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

namespace cohort {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(std::move(part));
  return parts;
}

bool has(const std::vector<std::string>& parts, const std::string& part) {
  return std::ranges::find(parts, part) != parts.end();
}

// A file system of control groups (man 5 proc_pid_mountinfo).
struct Mount {
  bool is_version_2 = false;
  fs::path group;  // group of the mounted folder
  fs::path folder;
};

std::vector<Mount> mounts_in(const fs::path& root, const std::string& controller) {
  std::vector<Mount> mounts;
  std::ifstream in(root / "proc/self/mountinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    const std::vector<std::string> place = split(line.substr(0, dash), ' ');
    const std::vector<std::string> kind = split(line.substr(dash + 3), ' ');
    if (place.size() < 5 || kind.size() < 3) continue;
    const bool is_version_2 = kind[0] == "cgroup2";
    if (!is_version_2 && (kind[0] != "cgroup" || !has(split(kind[2], ','), controller))) continue;
    mounts.push_back({is_version_2, place[3], root / fs::path(place[4]).relative_path()});
  }
  return mounts;
}

// Returns the group of this process in the mounted hierarchy.
std::optional<fs::path> group_of(const Mount& mount, const fs::path& root, const std::string& controller) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (mount.is_version_2 ? line.starts_with("0::") : has(split(controllers, ','), controller))
      return fs::path(line.substr(second + 1));
  }
  return std::nullopt;
}

}  // namespace

std::vector<ControlGroup> control_groups(const std::string& controller, const fs::path& root) {
  std::vector<ControlGroup> groups;
  for (const Mount& mount : mounts_in(root, controller)) {
    const auto group = group_of(mount, root, controller);
    if (!group) continue;
    fs::path folder = mount.folder;
    groups.push_back({mount.is_version_2, folder});
    const fs::path below = group->lexically_relative(mount.group);
    if (below.empty() || *below.begin() == "..") continue;
    for (const fs::path& name : below) groups.push_back({mount.is_version_2, folder /= name});
  }
  return groups;
}

}  // namespace cohort
