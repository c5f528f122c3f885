// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace cohort::recording {

/// The error thrown if a recording cannot be read or written. `what()` is `FILE: byte OFFSET: what was found and what
/// was expected`.
class McapError : public std::runtime_error {
 public:
  McapError(std::filesystem::path file, std::uint64_t offset, const std::string& problem)
      : std::runtime_error(file.string() + ": byte " + std::to_string(offset) + ": " + problem),
        file_(std::move(file)),
        offset_(offset),
        problem_(problem) {}

  const std::filesystem::path& file() const { return file_; }
  /// Returns the offset in the file; for an error inside of a chunk, the offset of the chunk.
  std::uint64_t offset() const { return offset_; }
  const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path file_;
  std::uint64_t offset_;
  std::string problem_;
};

/// The error thrown if a file cannot be opened, written or replaced. The message says what failed, where, why, and what
/// to do.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace cohort::recording
