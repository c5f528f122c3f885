// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

/// A model that was found for a URI.
struct FoundModel {
  std::filesystem::path file;  ///< in SDF, URDF or YAML
};

/// Finds the models that a world includes (docs/model-files.md). `model://NAME` or `package://NAME` is the folder NAME
/// in the first of these folders that has one:
/// - those of the environment variable COHORT_MODEL_PATH (separated by colons);
/// - `robots` and `objects` in the folder of the world file and in up to four parents;
/// - the `last_folders`;
/// - the folders of Gazebo and ROS;
/// - the folders that the user allows, and the folders above the file that contains the URI.
///
/// A searched folder may itself be the folder NAME. Any other URI is a name, or a path to the folder of a model or to
/// an SDF file. An address of Gazebo Fuel refers to the copy that Gazebo has downloaded.
class ModelSearch {
 public:
  /// `input` must outlive this.
  ModelSearch(InputFiles& input, const std::filesystem::path& world_file,
              const std::vector<std::filesystem::path>& last_folders);

  /// Finds a model. A path is relative to `folder`. Throws std::runtime_error with the missing name and the searched
  /// folders.
  FoundModel find(const std::string& uri, const std::filesystem::path& folder) const;
  /// Finds a file that is not a model, such as a mesh: `model://NAME/...` is in the folder of a model, and a path is
  /// relative to `folder`. Throws std::runtime_error like find().
  std::filesystem::path find_file(const std::string& uri, const std::filesystem::path& folder) const;

 private:
  std::filesystem::path path_of(const std::string& uri, const std::filesystem::path& folder, bool is_model) const;
  [[noreturn]] void fail_to_find(const std::string& name) const;
  [[noreturn]] void fail_to_find_file(const std::string& file, const std::filesystem::path& folder) const;
  std::string searched_folders() const;
  // Returns the names of the models on the disk, for suggestions.
  std::vector<std::string> known_models() const;
  /// `folder` is that of the file that contains the name.
  std::optional<std::filesystem::path> look_for(const std::string& name, const std::filesystem::path& folder,
                                                const std::filesystem::path& inside) const;
  std::optional<std::filesystem::path> look_in(const std::filesystem::path& above, const std::string& name,
                                               const std::filesystem::path& inside,
                                               const std::function<bool(const std::filesystem::path&)>& has_it) const;
  bool is_signed(const std::filesystem::path& folder) const;
  std::optional<std::filesystem::path> find_file_above(const std::string& path, std::filesystem::path folder) const;
  bool is_package(const std::filesystem::path& folder, const std::string& name) const;
  /// Finds a package whose folder has another name, at any depth below the folders of Gazebo and ROS.
  std::optional<std::filesystem::path> find_package(const std::string& name) const;
  std::filesystem::path find_fetched(const std::string& uri) const;
  std::string newest_version(const std::filesystem::path& model) const;

  /// Returns the SDF file in the folder of a model.
  std::filesystem::path sdf_file_of(const std::filesystem::path& folder) const;

  InputFiles& input_;
  std::filesystem::path world_folder_;
  std::vector<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> others_;                                     // folders of Gazebo and ROS
  mutable std::optional<std::map<std::string, std::filesystem::path>> packages_;  // below them, by name
};

}  // namespace cohort::parsing
