#pragma once

#include <filesystem>
#include <mutex>
#include <optional>

#include "server/core/atomic_file.hpp"
#include "server/recording/mcap/writing/byte_store.hpp"

namespace cohort::recording {

/// A file that is written from its beginning to its end. While it is open nobody else can open it so. What it replaces
/// stays until the first `sync`, and for good if there is none. What fails throws FileError: what, where, why, what to
/// do.
class DiskFile : public ByteStore {
 public:
  /// Makes the file, or one that is to replace it.
  explicit DiskFile(std::filesystem::path path);
  ~DiskFile() override;

  const std::filesystem::path& path() const { return path_; }
  std::string name() const override { return "the recording " + path_.string(); }
  void write(ByteView bytes) override;
  void cut_off(std::uint64_t size) override;
  /// Returns when everything that was written is on the disk, under the file's name.
  void sync() override;
  void finish() override { sync(); }

 private:
  [[noreturn]] void fail(int error) const;
  void lock() const;
  void write_beside();
  void close_all();

  std::filesystem::path path_;
  int descriptor_ = -1;
  int replaced_ = -1;                 // what was there, locked
  std::mutex mutex_;                  // guards the next two
  std::optional<AtomicFile> beside_;  // this file, until it has its name
  bool has_its_name_ = false;
};

/// Throws FileError if somebody writes to the file through a DiskFile at this time.
void check_not_being_written(const std::filesystem::path& path);

}  // namespace cohort::recording
