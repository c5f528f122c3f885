#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cohort {

/// What was found cannot be written: what, to which file, why, and what to do.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What this number of an error means for a file that is written, and what to do.
std::string why_not_written(int error);

/// Throws WriteError with this message where a disk is full or broken; otherwise std::runtime_error, since another file
/// could be named.
[[noreturn]] void refuse_to_write(const std::string& message, int error);

/// Returns when the names in the folder of `file` are safe from a power cut: 0, or the number of the error.
int sync_folder_of(const std::filesystem::path& file);

/// A file that takes the place of what has its name as a whole or not at all, whatever happens meanwhile: it is written
/// beside it and put there once all of it is on the disk. A symbolic link of that name is replaced, not followed. What
/// is no file (a pipe, a terminal), or stands where nothing can take its place, is written to as it is. What fails
/// throws WriteError.
class AtomicFile {
 public:
  /// `what`: the contents, for messages, such as `the summary`.
  AtomicFile(std::string_view what, std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Without `commit` nothing has happened.
  ~AtomicFile();

  /// What is written until `commit`, for libraries that write files themselves.
  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view bytes);
  /// Returns when the file has its name, and keeps it if the power fails. If it throws, it may be called again.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::string what_;
  std::filesystem::path target_;
  std::filesystem::path path_;  // `target_` if that is written in place
  int descriptor_ = -1;
};

}  // namespace cohort
