#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cohort::parsing {

/// The folders below which files may be read that other files name. A world from a stranger may name whatever its
/// reader has, and recordings keep what was read; so a world reads its own folders, and those that a person has named.
class TrustedFolders {
 public:
  /// With all that is below it. One that is not there is none.
  void add(const std::filesystem::path& folder);
  /// What belongs to a file that a person has named: its folder; the package, model or repository that this is in (the
  /// nearest folder with `package.xml`, `model.config` or `.git`, below the home folder if there is one); and folders
  /// such as `robots` and `meshes` (docs/worlds.md) beside it or beside one of the four above.
  void add_around(const std::filesystem::path& file);

  /// Whether this is below one of them, where symbolic links lead.
  bool contains(const std::filesystem::path& file) const;

 private:
  std::vector<std::filesystem::path> folders_;  // absolute, without symbolic links
};

}  // namespace cohort::parsing
