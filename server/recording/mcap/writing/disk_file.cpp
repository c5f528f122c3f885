#include "server/recording/mcap/writing/disk_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "server/recording/mcap/format/mcap_error.hpp"

namespace cohort::recording {
namespace {

std::string advice(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR: return "; its folder has to be there";
    case EACCES:
    case EPERM:
    case EROFS: return "; record to a folder that you may write to";
    case ENOSPC:
    case EDQUOT: return "; free some space there, or record to another disk";
    case EFBIG: return "; raise the limit of file sizes (ulimit -f), or record to another file system";
    default: return "";
  }
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw FileError("the recording " + path.string() + " cannot be written: " + reason);
}

constexpr const char* is_taken = "another process is recording to it";

}  // namespace

void DiskFile::fail(int error) const { refuse(path_, std::generic_category().message(error) + advice(error)); }

DiskFile::DiskFile(std::filesystem::path path) : path_(std::move(path)) {
  // Not blocking, so that a pipe that nobody reads from is refused below.
  descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor_ < 0) fail(errno);
  struct stat status {};
  std::string reason;
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) reason = "it is no file";
  if (reason.empty() && flock(descriptor_, LOCK_EX | LOCK_NB) != 0) reason = is_taken;
  if (reason.empty() && ftruncate(descriptor_, 0) != 0) reason = std::generic_category().message(errno);
  if (reason.empty()) return;
  close(descriptor_);
  refuse(path_, reason);
}

DiskFile::~DiskFile() { close(descriptor_); }

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
  if (fdatasync(descriptor_) != 0) fail(errno);
}

void check_not_being_written(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return;  // whoever reads it says why
  const bool is_free = flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  close(descriptor);
  if (!is_free) refuse(path, is_taken);
}

}  // namespace cohort::recording
