#pragma once

#include <filesystem>

#include "server/recording/mcap.hpp"

namespace cohort::recording {

/// A file that is written from its beginning to its end. While it is open nobody else can open it so. `write`,
/// `cut_off` and `size` by one thread, `sync` by another if need be. What fails throws FileError: what, where, why,
/// what to do.
class DiskFile {
 public:
  /// Makes the file, or empties it.
  explicit DiskFile(std::filesystem::path path);
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;
  ~DiskFile();

  const std::filesystem::path& path() const { return path_; }
  /// All of them; if it throws, maybe some.
  void write(ByteView bytes);
  /// Forgets what was written after the first `size` bytes.
  void cut_off(std::uint64_t size);
  /// Returns when everything that was written is on the disk.
  void sync();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Throws FileError if somebody writes to the file through a DiskFile at this time.
void check_not_being_written(const std::filesystem::path& path);

}  // namespace cohort::recording
