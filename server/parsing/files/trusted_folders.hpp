// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cohort::parsing {

/// Folders below which worlds and models may read files. An untrusted world could refer to any file of the user who
/// reads it, and recordings keep the files that were read. Therefore a world may read only its own folders, and those
/// that the user has named.
class TrustedFolders {
 public:
  /// Adds a folder with everything below it; ignores one that does not exist.
  void add(const std::filesystem::path& folder);
  /// Adds the folders around a file that the user has named:
  /// - its folder;
  /// - the package, model or repository that contains it: the nearest folder with `package.xml`, `model.config` or
  /// `.git`, below the home folder if there is one;
  /// - folders such as `robots` and `meshes` (docs/model-files.md) in its folder or in one of the four folders above.
  void add_around(const std::filesystem::path& file);

  /// Returns whether the file is below one of them, with symbolic links resolved.
  bool contains(const std::filesystem::path& file) const;

 private:
  std::vector<std::filesystem::path> folders_;  // absolute, without symbolic links
};

}  // namespace cohort::parsing
