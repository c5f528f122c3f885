// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// Returns why a file that the user named cannot be read, such as "there is no such file"; nothing if it can.
std::optional<std::string> why_unreadable(const std::filesystem::path& file);

/// Returns `file` with symbolic links in its folder resolved. After that, ".." in paths can be resolved as text with
/// the same meaning as in the file system.
std::filesystem::path without_links(const std::filesystem::path& file);

/// The only access to the files of a world: either from the disk, keeping everything that is read, or from kept files,
/// without access to the disk. Each file is read once, so all readers see the same content. Paths that differ only in
/// "." and ".." are one file. From the disk, only files in trusted folders are read: those of `model_path()` and those
/// that `trust` adds. For use by one thread.
class InputFiles {
 public:
  /// Reads from the disk.
  InputFiles();
  /// Reads only from `kept`; other files do not exist.
  explicit InputFiles(std::shared_ptr<const KeptFiles> kept);
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  /// Trusts a file that the user has named: the file itself, the folders around it (TrustedFolders::add_around), and
  /// the parent folders of `last_model_folders`.
  void trust(const std::filesystem::path& file, const std::vector<std::filesystem::path>& last_model_folders = {});

  /// Uses `bytes` as the content of `file` from now on.
  void add(const std::filesystem::path& file, std::string bytes);
  /// Does the same for the output of `xacro` for the file.
  void add_expanded(const std::filesystem::path& file, std::string bytes);
  bool is_expanded(const std::filesystem::path& file) const { return expanded_.contains(key_of(file)); }

  /// Replaces the settings of the experiment: values that a user sets in place of those of its files, as PATH=VALUE.
  void set(std::vector<std::string> settings) { settings_ = std::move(settings); }
  const std::vector<std::string>& settings() const { return settings_; }
  /// Sets values in one of the files when it is read. Their paths begin at the top of this file.
  void set_in(const std::filesystem::path& file, std::vector<std::string> settings);
  const std::vector<std::string>& settings_of(const std::filesystem::path& file) const;

  /// Returns why the file cannot be read, such as "there is no such file"; nothing if it can.
  std::optional<std::string> why_unreadable(const std::filesystem::path& file) const;
  /// Returns the content, whose address does not change during the lifetime of this. Throws std::runtime_error with the
  /// reason if it cannot be read.
  const std::string& read(const std::filesystem::path& file);
  /// Returns the content of a file that can be read, and does not keep it.
  std::string content(const std::filesystem::path& file) const;
  /// Returns the number of bytes of a file that can be read.
  std::uintmax_t size(const std::filesystem::path& file) const;
  bool is_file(const std::filesystem::path& file) const;
  bool is_folder(const std::filesystem::path& folder);
  /// Returns the files with this name in a folder and its subfolders, sorted. Folders below a folder that has such a
  /// file are not searched. Returns nothing for a folder with more than 100,000 files and folders. Links are not
  /// followed.
  std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder, const std::string& name) const;

  /// Notes that a file to which another one refers is not there.
  void note_missing() { lacks_file_ = true; }
  bool lacks_file() const { return lacks_file_; }

  /// Returns whether files are read from the disk.
  bool is_disk() const { return !source_; }

  /// Returns the absolute path without "." and "..".
  std::filesystem::path absolute(const std::filesystem::path& path) const;
  /// Returns folders of models, separated by colons: those of COHORT_MODEL_PATH, an empty entry, the search folders of
  /// Gazebo and ROS, those of COHORT_ALLOW_FILES, and the download folders of Gazebo.
  const std::string& model_path() const { return model_path_; }

  /// Returns all files that were read so far; the caller sets `experiment` and `last_model_folders`.
  KeptFiles kept() const;

 private:
  // Returns the absolute path without ".", ".." and a final slash.
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
  bool lacks_file_ = false;
  std::vector<std::string> settings_;
  std::map<std::string, std::vector<std::string>> settings_of_;  // by key
};

}  // namespace cohort::parsing
