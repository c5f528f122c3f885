// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cohort {

/// The error thrown if a file cannot be written. The message says what could not be written, to which file, why, and
/// what to do.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the meaning of an errno value from writing a file, and what to do.
std::string why_not_written(int error);

/// Throws WriteError with this message if the disk is full or broken. Otherwise throws std::runtime_error, as the user
/// could name another file.
[[noreturn]] void refuse_to_write(const std::string& message, int error);

/// Synchronizes the folder of `file` with the disk, so that the names in it survive a power failure. Returns 0, or an
/// errno value.
int sync_folder_of(const std::filesystem::path& file);

/// A file that replaces an existing one as a whole or not at all, even after a crash. It is written beside the target,
/// and moved there once all of it is on the disk. A symbolic link of that name is replaced, not followed. A target that
/// is not a regular file (a pipe, a terminal), or that cannot be replaced, is written in place. Errors throw
/// WriteError.
class AtomicFile {
 public:
  /// `what`: the contents, for messages, such as `the summary`.
  AtomicFile(std::string_view what, std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Discards the file unless `commit` was called.
  ~AtomicFile();

  /// Returns the file to write until `commit`, for libraries that write files themselves.
  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view bytes);
  /// Gives the file its name, and returns when that would survive a power failure. May be called again after an
  /// exception.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::string what_;
  std::filesystem::path target_;
  std::filesystem::path path_;  // `target_` if that is written in place
  int descriptor_ = -1;
};

}  // namespace cohort
