#pragma once

#include <filesystem>

#include "server/recording/mcap/writing/byte_store.hpp"

namespace cohort::recording {

/// A file that is written from its beginning to its end. While it is open nobody else can open it so. What fails throws
/// FileError: what, where, why, what to do.
class DiskFile : public ByteStore {
 public:
  /// Makes the file, or empties it.
  explicit DiskFile(std::filesystem::path path);
  ~DiskFile() override;

  const std::filesystem::path& path() const { return path_; }
  void write(ByteView bytes) override;
  void cut_off(std::uint64_t size) override;
  /// Returns when everything that was written is on the disk.
  void sync() override;
  void finish() override { sync(); }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Throws FileError if somebody writes to the file through a DiskFile at this time.
void check_not_being_written(const std::filesystem::path& path);

}  // namespace cohort::recording
