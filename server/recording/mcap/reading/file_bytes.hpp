#pragma once

#include <filesystem>

#include "server/recording/mcap/format/mcap_records.hpp"

namespace cohort::recording {

/// A file that is read here and there, of the size that it had when it was opened. Any thread.
class FileBytes {
 public:
  /// Throws FileError if it cannot be opened or is no file.
  explicit FileBytes(std::filesystem::path path);
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  ~FileBytes();

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  Place at(std::uint64_t offset) const { return {&path_, offset, {}}; }
  /// Throws McapError if it ends before, or cannot be read.
  void read(std::uint64_t offset, std::span<std::byte> to) const;
  /// The same. Checks before it takes memory.
  Bytes read(std::uint64_t offset, std::uint64_t size) const;
  /// CRC of the bytes from `from` to before `to`, both in the file.
  std::uint32_t crc(std::uint64_t from, std::uint64_t to) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// A file read from its beginning to its end in small pieces.
class FileWindow {
 public:
  explicit FileWindow(const FileBytes& file) : file_(file) {}

  /// Up to `size` bytes, fewer at the end of the file; they live until the next call.
  ByteView peek(std::uint64_t offset, std::size_t size);
  /// Exactly `size` bytes. Throws McapError.
  ByteView get(std::uint64_t offset, std::uint64_t size);

 private:
  const FileBytes& file_;
  Bytes bytes_;
  std::uint64_t start_ = 0;
};

}  // namespace cohort::recording
