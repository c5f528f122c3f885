// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/trusted_folders.hpp"

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

constexpr int levels_above = 4;
// Usual folders for files of worlds and models, in Cohort, Gazebo and ROS.
constexpr const char* usual_names[] = {"arenas",  "assets", "description", "experiments", "launch",  "materials",
                                       "media",   "mesh",   "meshes",      "models",      "objects", "robots",
                                       "samples", "sdf",    "urdf",        "worlds",      "xacro"};

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool is_package_or_repository(const fs::path& folder) {
  std::error_code none;
  return std::ranges::any_of(std::initializer_list<const char*>{"package.xml", "model.config", ".git"},
                             [&](const char* sign) { return fs::exists(folder / sign, none); });
}

// The home folder and its parents do not count as packages.
bool holds_home(const fs::path& folder) {
  const char* const home = std::getenv("HOME");
  std::error_code none;
  return home != nullptr && *home != '\0' && is_below(fs::weakly_canonical(home, none), folder);
}

}  // namespace

void TrustedFolders::add(const fs::path& folder) {
  std::error_code missing;
  fs::path real = fs::canonical(folder, missing);
  if (!missing && !contains(real)) folders_.push_back(std::move(real));
}

void TrustedFolders::add_around(const fs::path& file) {
  std::error_code missing;
  fs::path folder = fs::canonical(fs::absolute(file, missing).parent_path(), missing);
  if (missing) return;
  add(folder);
  for (fs::path above = folder; above != above.parent_path() && !holds_home(above); above = above.parent_path())
    if (is_package_or_repository(above)) {
      add(above);
      break;
    }
  for (int level = 0; level <= levels_above && folder != folder.parent_path(); ++level, folder = folder.parent_path())
    for (const char* const name : usual_names)
      if (!fs::is_symlink(folder / name, missing)) add(folder / name);  // which could lead anywhere
}

bool TrustedFolders::contains(const fs::path& file) const {
  std::error_code unreadable;
  const fs::path real = fs::weakly_canonical(file, unreadable);
  return !unreadable && std::ranges::any_of(folders_, [&](const fs::path& folder) { return is_below(real, folder); });
}

}  // namespace cohort::parsing
