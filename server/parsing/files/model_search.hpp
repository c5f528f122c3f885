#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

/// A model that a URI leads to.
struct FoundModel {
  std::filesystem::path file;  ///< in SDF, URDF or YAML
};

/// Finds the models that a world includes (docs/worlds.md). `model://NAME` is the folder NAME in the first of these
/// that has one (`package://` means the same): the folders of the environment variable COHORT_MODEL_PATH (separated by
/// colons), `robots` and `objects` in the folder of the world file and in its parents, four levels up, the
/// `last_folders`, the folders of Gazebo and ROS, those that a person allows, and those above the file that names it.
/// One of these may be NAME itself. Any other URI is a path, to a model's folder or to an SDF file, or a name; an
/// address of Gazebo Fuel is what Gazebo has fetched from there.
class ModelSearch {
 public:
  /// `input` must outlive this.
  ModelSearch(InputFiles& input, const std::filesystem::path& world_file,
              const std::vector<std::filesystem::path>& last_folders);

  /// Throws std::runtime_error that says what is missing and where it was looked for.
  /// A path is relative to `folder`.
  FoundModel find(const std::string& uri, const std::filesystem::path& folder) const;
  /// A file that is no model, such as a mesh: `model://NAME/...` is in a model's folder, and a path is relative to
  /// `folder`. Throws std::runtime_error as well.
  std::filesystem::path find_file(const std::string& uri, const std::filesystem::path& folder) const;

 private:
  std::filesystem::path path_of(const std::string& uri, const std::filesystem::path& folder, bool is_model) const;
  [[noreturn]] void fail_to_find(const std::string& name) const;
  [[noreturn]] void fail_to_find_file(const std::string& file, const std::filesystem::path& folder) const;
  std::string searched_folders() const;
  /// `folder` is that of the file that names it.
  std::optional<std::filesystem::path> look_for(const std::string& name, const std::filesystem::path& folder,
                                                const std::filesystem::path& inside) const;
  bool is_signed(const std::filesystem::path& folder) const;
  std::optional<std::filesystem::path> find_file_above(const std::string& path, std::filesystem::path folder) const;
  bool is_package(const std::filesystem::path& folder, const std::string& name) const;
  std::filesystem::path find_fetched(const std::string& uri) const;
  std::string newest_version(const std::filesystem::path& model) const;

  /// The SDF file of a model's folder.
  std::filesystem::path sdf_file_of(const std::filesystem::path& folder) const;

  InputFiles& input_;
  std::filesystem::path world_folder_;
  std::vector<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> others_;  // of Gazebo and ROS
};

}  // namespace cohort::parsing
