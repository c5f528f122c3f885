#include "server/core/processors.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace cohort {
namespace {

namespace fs = std::filesystem;

constexpr double no_quota = std::numeric_limits<double>::infinity();

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(std::move(part));
  return parts;
}

bool has(const std::vector<std::string>& parts, const std::string& part) {
  return std::ranges::find(parts, part) != parts.end();
}

// A file system of control groups with processor quotas (man 7 cgroups, man 5 proc_pid_mountinfo).
struct Mount {
  bool is_version_2 = false;
  fs::path group;  // group of the mounted folder
  fs::path folder;
};

std::vector<Mount> mounts_in(const fs::path& root) {
  std::vector<Mount> mounts;
  std::ifstream in(root / "proc/self/mountinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    const std::vector<std::string> place = split(line.substr(0, dash), ' ');
    const std::vector<std::string> kind = split(line.substr(dash + 3), ' ');
    if (place.size() < 5 || kind.size() < 3) continue;
    const bool is_version_2 = kind[0] == "cgroup2";
    if (!is_version_2 && (kind[0] != "cgroup" || !has(split(kind[2], ','), "cpu"))) continue;
    mounts.push_back({is_version_2, place[3], root / fs::path(place[4]).relative_path()});
  }
  return mounts;
}

// Returns the group of this process in the mounted hierarchy.
std::optional<fs::path> group_of(const Mount& mount, const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (mount.is_version_2 ? line.starts_with("0::") : has(split(controllers, ','), "cpu"))
      return fs::path(line.substr(second + 1));
  }
  return std::nullopt;
}

// Returns the quota in cores.
double quota_in(const fs::path& folder, bool is_version_2) {
  std::string quota;
  double period = 0.0;
  if (is_version_2) {
    std::ifstream(folder / "cpu.max") >> quota >> period;
  } else {
    std::ifstream(folder / "cpu.cfs_quota_us") >> quota;
    std::ifstream(folder / "cpu.cfs_period_us") >> period;
  }
  const double microseconds = std::strtod(quota.c_str(), nullptr);  // "max" and -1: no quota
  return microseconds > 0.0 && period > 0.0 ? microseconds / period : no_quota;
}

// Returns the least quota of a group and its visible parents.
double quota_of(const Mount& mount, const fs::path& root) {
  const auto group = group_of(mount, root);
  if (!group) return no_quota;
  double least = quota_in(mount.folder, mount.is_version_2);
  fs::path folder = mount.folder;
  const fs::path below = group->lexically_relative(mount.group);
  if (below.empty() || *below.begin() == "..") return least;
  for (const fs::path& name : below) {
    folder /= name;
    least = std::min(least, quota_in(folder, mount.is_version_2));
  }
  return least;
}

}  // namespace

unsigned available_processors(const fs::path& root) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  double quota = no_quota;
  for (const Mount& mount : mounts_in(root)) quota = std::min(quota, quota_of(mount, root));
  return quota < cores ? std::max(1u, static_cast<unsigned>(quota)) : cores;
}

}  // namespace cohort
