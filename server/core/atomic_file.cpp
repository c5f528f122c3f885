// SPDX-License-Identifier: Apache-2.0
#include "server/core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace cohort {
namespace {

// Returns the mode of a new file. The mask cannot be read without setting it for a moment, which other threads would
// see.
mode_t usual_mode() {
  static const mode_t mode = [] {
    const mode_t mask = umask(022);
    umask(mask);
    return static_cast<mode_t>(0666 & ~mask);
  }();
  return mode;
}

// Returns true for /dev/stdout and the like, which may be a regular file.
bool is_of_this_process(const std::filesystem::path& file) {
  const std::string folder = std::filesystem::absolute(file).lexically_normal().parent_path().string();
  return folder == "/dev" || folder == "/dev/fd" || folder.starts_with("/proc/");
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

// Returns true for a mounted file, as in a container.
bool is_mounted(const std::filesystem::path& file) {
  struct statx facts {};
  const bool is_known = statx(AT_FDCWD, file.c_str(), AT_SYMLINK_NOFOLLOW, 0, &facts) == 0;
  return is_known && (facts.stx_attributes & facts.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) != 0;
}

}  // namespace

std::string why_not_written(int error) {
  const std::string reason = std::generic_category().message(error);
  switch (error) {
    case ENOENT:
    case ENOTDIR: return reason + "; its folder must exist";
    case EACCES:
    case EPERM:
    case EROFS: return reason + "; choose a folder that you can write to";
    case ENOSPC:
    case EDQUOT: return reason + "; free some space, or choose another disk";
    case EFBIG: return reason + "; raise the limit of the file size (ulimit -f), or choose another file system";
    default: return reason;
  }
}

void refuse_to_write(const std::string& message, int error) {
  const std::string text = message + ": " + why_not_written(error);
  if (error == ENOSPC || error == EDQUOT || error == EIO) throw WriteError(text);
  throw std::runtime_error(text);
}

int sync_folder_of(const std::filesystem::path& file) {
  const int descriptor = open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return 0;  // it can be written but not read
  const int error = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  return error == EINVAL ? 0 : error;  // some file systems do not support it
}

void AtomicFile::fail(int error) const {
  throw WriteError(what_ + " cannot be written to " + target_.string() + ": " + why_not_written(error));
}

AtomicFile::AtomicFile(std::string_view what, std::filesystem::path target)
    : what_(what), target_(std::move(target)), path_(target_) {
  struct stat status {};
  const bool is_there = stat(target_.c_str(), &status) == 0;
  if (is_there && S_ISDIR(status.st_mode)) fail(EISDIR);
  const bool is_file = is_there && S_ISREG(status.st_mode) && !is_of_this_process(target_);
  if (is_file && access(target_.c_str(), W_OK) != 0) fail(errno);
  // Write in place if the target is not a regular file, is in a folder without write permission, or is a mount point.
  if (is_there && (!is_file || access(folder_of(target_).c_str(), W_OK | X_OK) != 0 || is_mounted(target_))) {
    descriptor_ = open(target_.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  std::string name = (target_.parent_path() / ("." + target_.filename().string() + ".XXXXXX")).string();
  descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
  path_ = name;
  fchmod(descriptor_, is_there ? status.st_mode & 07777U : usual_mode());
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (path_ != target_) unlink(path_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void AtomicFile::commit() {
  if (path_ == target_) {
    if (close(std::exchange(descriptor_, -1)) != 0) fail(errno);
    return;
  }
  if (descriptor_ >= 0) {  // none: it was here before, and its name could not be given
    if (fsync(descriptor_) != 0) fail(errno);
    if (close(std::exchange(descriptor_, -1)) != 0) fail(errno);
  }
  if (rename(path_.c_str(), target_.c_str()) != 0) fail(errno);
  path_ = target_;
  if (const int error = sync_folder_of(target_); error != 0) fail(error);
}

}  // namespace cohort
