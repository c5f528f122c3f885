// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/recording/mcap/format/mcap_records.hpp"

namespace cohort::recording {

/// A file with random access. Its size is determined when it is opened. For any thread.
class FileBytes {
 public:
  /// Throws FileError if the file cannot be opened or is not a regular file.
  explicit FileBytes(std::filesystem::path path);
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  ~FileBytes();

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  Place at(std::uint64_t offset) const { return {&path_, offset, {}}; }
  /// Fills `to` with the bytes from `offset` on. Throws McapError if the file ends too early, or cannot be read.
  void read(std::uint64_t offset, std::span<std::byte> to) const;
  /// Returns `size` bytes from `offset` on. Checks the size before it allocates memory. Throws McapError likewise.
  Bytes read(std::uint64_t offset, std::uint64_t size) const;
  /// Returns the CRC of the bytes in [`from`, `to`), which must be in the file.
  std::uint32_t crc(std::uint64_t from, std::uint64_t to) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// A file that is read from beginning to end in small pieces.
class FileWindow {
 public:
  explicit FileWindow(const FileBytes& file) : file_(file) {}

  /// Returns up to `size` bytes, fewer at the end of the file. They are valid until the next call.
  ByteView peek(std::uint64_t offset, std::size_t size);
  /// Returns exactly `size` bytes. Throws McapError.
  ByteView get(std::uint64_t offset, std::uint64_t size);

 private:
  const FileBytes& file_;
  Bytes bytes_;
  std::uint64_t start_ = 0;
};

}  // namespace cohort::recording
