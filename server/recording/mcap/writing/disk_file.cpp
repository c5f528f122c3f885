// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/writing/disk_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "server/recording/mcap/format/mcap_error.hpp"

namespace cohort::recording {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw FileError("the recording " + path.string() + " cannot be written: " + reason);
}

constexpr const char* is_taken = "another process is recording to it";

}  // namespace

void DiskFile::fail(int error) const { refuse(path_, why_not_written(error)); }

DiskFile::DiskFile(std::filesystem::path path) : path_(std::move(path)) {
  // Opens without blocking, so that a pipe without a reader is refused below.
  descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor_ < 0) fail(errno);
  try {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) refuse(path_, "it is not a regular file");
    lock();
    struct stat now {};
    if (stat(path_.c_str(), &now) == 0 && now.st_ino != status.st_ino)
      refuse(path_, is_taken);  // replaced a moment ago
    if (status.st_size > 0) write_beside();
  } catch (...) {
    close_all();
    throw;
  }
}

DiskFile::~DiskFile() { close_all(); }

void DiskFile::lock() const {
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) refuse(path_, is_taken);
}

void DiskFile::close_all() {
  for (int* const descriptor : {&descriptor_, &replaced_})
    if (*descriptor >= 0) close(std::exchange(*descriptor, -1));
}

// Keeps an existing file, locked, until data of this recording is on the disk.
void DiskFile::write_beside() {
  try {
    beside_.emplace("the recording", std::filesystem::canonical(path_));
  } catch (const WriteError& error) {
    throw FileError(error.what());
  }
  if (std::filesystem::equivalent(beside_->path(), path_))  // it cannot be replaced, so it was truncated
    return beside_.reset();
  const int beside = open(beside_->path().c_str(), O_WRONLY | O_CLOEXEC);
  if (beside < 0) fail(errno);
  replaced_ = std::exchange(descriptor_, beside);
  lock();
}

void DiskFile::write(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void DiskFile::cut_off(std::uint64_t size) {
  const auto offset = static_cast<off_t>(size);
  if (ftruncate(descriptor_, offset) != 0 || lseek(descriptor_, offset, SEEK_SET) < 0) fail(errno);
}

void DiskFile::sync() {
  const std::lock_guard lock(mutex_);
  if (fdatasync(descriptor_) != 0) fail(errno);
  if (has_its_name_) return;
  if (beside_) {
    try {
      beside_->commit();
    } catch (const WriteError& error) {
      throw FileError(error.what());
    }
  } else if (const int error = sync_folder_of(path_); error != 0) {
    fail(error);
  }
  has_its_name_ = true;
}

void check_not_being_written(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return;  // reading it reports the reason
  const bool is_free = flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  close(descriptor);
  if (!is_free) refuse(path, is_taken);
}

}  // namespace cohort::recording
