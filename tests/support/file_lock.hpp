#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace cohort::test {

/// Takes a DDS domain from all other tests of this machine: the file to close when it is free again, negative if
/// another has it.
inline int lock_domain(std::uint32_t domain) {
  const auto path = std::filesystem::temp_directory_path() / ("cohort-test-domain-" + std::to_string(domain));
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (file < 0 || flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  close(file);
  return -1;
}

/// Among all processes one at a time has a file while this lives.
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
