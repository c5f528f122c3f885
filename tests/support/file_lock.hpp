// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace cohort::test {

/// Reserves a DDS domain among all tests of this machine. Returns a file descriptor, which must be closed to release
/// the domain, or a negative number if the domain is reserved.
inline int lock_domain(std::uint32_t domain) {
  const auto path = std::filesystem::temp_directory_path() / ("cohort-test-domain-" + std::to_string(domain));
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (file < 0 || flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  close(file);
  return -1;
}

/// An exclusive lock on a file among all processes, held during its lifetime.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& file) : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    flock(file_, LOCK_EX);
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock() { close(file_); }

 private:
  int file_;
};

}  // namespace cohort::test
