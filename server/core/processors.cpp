// SPDX-License-Identifier: Apache-2.0
#include "server/core/processors.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "server/core/control_groups.hpp"

namespace cohort {
namespace {

namespace fs = std::filesystem;

constexpr double no_quota = std::numeric_limits<double>::infinity();

// Returns the quota in cores.
double quota_in(const ControlGroup& group) {
  std::string quota;
  double period = 0.0;
  if (group.is_version_2) {
    std::ifstream(group.folder / "cpu.max") >> quota >> period;
  } else {
    std::ifstream(group.folder / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group.folder / "cpu.cfs_period_us") >> period;
  }
  const double microseconds = std::strtod(quota.c_str(), nullptr);  // "max" and -1: no quota
  return microseconds > 0.0 && period > 0.0 ? microseconds / period : no_quota;
}

}  // namespace

unsigned available_processors(const fs::path& root) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  double quota = no_quota;
  for (const ControlGroup& group : control_groups("cpu", root)) quota = std::min(quota, quota_in(group));
  return quota < cores ? std::max(1u, static_cast<unsigned>(quota)) : cores;
}

}  // namespace cohort
