// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>

#include "server/core/atomic_file.hpp"
#include "server/recording/mcap/writing/byte_store.hpp"

namespace cohort::recording {

/// A file that is written from beginning to end. While it is open, no other DiskFile can open it. A file that it
/// replaces stays until the first `sync`, and for good if there is none. On failure, the functions throw FileError,
/// which says what failed, where, why, and what to do.
class DiskFile : public ByteStore {
 public:
  /// Creates the file, or a new one that will replace an existing file.
  explicit DiskFile(std::filesystem::path path);
  ~DiskFile() override;

  const std::filesystem::path& path() const { return path_; }
  std::string name() const override { return "the recording " + path_.string(); }
  void write(ByteView bytes) override;
  void cut_off(std::uint64_t size) override;
  /// Returns when all written data is on the disk, under the file's name.
  void sync() override;
  void finish() override { sync(); }

 private:
  [[noreturn]] void fail(int error) const;
  void lock() const;
  void write_beside();
  void close_all();

  std::filesystem::path path_;
  int descriptor_ = -1;
  int replaced_ = -1;                 // the replaced file, locked
  std::mutex mutex_;                  // guards the next two members
  std::optional<AtomicFile> beside_;  // this file, until it has its final name
  bool has_its_name_ = false;
};

/// Throws FileError if the file is currently being written through a DiskFile.
void check_not_being_written(const std::filesystem::path& path);

}  // namespace cohort::recording
