#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/description/kept_files.hpp"
#include "server/parsing/files/trusted_folders.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Why a file that a person named cannot be read, such as "there is no such file"; nothing if it can.
std::optional<std::string> why_unreadable(const std::filesystem::path& file);

/// Returns `file` as it was named, or, if a symbolic link leads to its folder, in the folder that the link leads to.
/// From there the text of a path alone says what it means: ".." in a file means what it means to the system.
std::filesystem::path without_links(const std::filesystem::path& file);

/// The one way to the files of a world: from the disk, keeping what it has read, or from what was kept, without looking
/// at the disk at all. Each file is read once, so that all readers see the same content; paths that differ only in "."
/// and ".." are one file, on the disk and among what was kept. From the disk only what is in trusted folders is read:
/// those of `model_path()` and what `trust` adds. One thread uses it.
class InputFiles {
 public:
  /// From the disk.
  InputFiles();
  /// From `kept` alone: what is not in it does not exist.
  explicit InputFiles(std::shared_ptr<const KeptFiles> kept);
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  /// A person has named this file: it may be read, and what belongs to it (TrustedFolders::add_around), and what comes
  /// with Cohort beside its folders of models.
  void trust(const std::filesystem::path& file, const std::vector<std::filesystem::path>& last_model_folders = {});

  /// Answers for `file` with `bytes` from now on.
  void add(const std::filesystem::path& file, std::string bytes);
  /// The same of what `xacro` has made of the file.
  void add_expanded(const std::filesystem::path& file, std::string bytes);
  bool is_expanded(const std::filesystem::path& file) const { return expanded_.contains(key_of(file)); }

  /// As the function above.
  std::optional<std::string> why_unreadable(const std::filesystem::path& file) const;
  /// The content, which stays where it is as long as this lives. Throws std::runtime_error that says why there is none.
  const std::string& read(const std::filesystem::path& file);
  bool is_file(const std::filesystem::path& file) const;
  bool is_folder(const std::filesystem::path& folder);

  /// Whether what is read stands on the disk, where its user has named it.
  bool is_disk() const { return !source_; }

  /// Without "." and "..".
  std::filesystem::path absolute(const std::filesystem::path& path) const;
  /// Folders of models, separated by colons: those of COHORT_MODEL_PATH, an empty one, those where Gazebo and ROS look,
  /// those of COHORT_ALLOW_FILES, and those where Gazebo keeps what it has fetched.
  const std::string& model_path() const { return model_path_; }

  /// What reading has taken so far; `experiment` and `last_model_folders` are for those to fill in who know them.
  KeptFiles kept() const;

 private:
  // Absolute, without ".", ".." and a slash at its end.
  std::string key_of(const std::filesystem::path& path) const;
  const std::string* find(const std::string& key) const;

  std::shared_ptr<const KeptFiles> source_;         // null: the disk
  std::map<std::string, const std::string*> kept_;  // content of `source_` by key
  std::filesystem::path working_folder_;
  std::string model_path_;
  TrustedFolders trusted_;
  std::map<std::string, std::string> files_;  // by key
  std::set<std::string> folders_;             // keys, as the next
  std::set<std::string> expanded_;
};

}  // namespace cohort::parsing
