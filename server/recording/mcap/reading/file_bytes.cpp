// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/file_bytes.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "server/recording/mcap/format/crc32.hpp"

namespace cohort::recording {
namespace {

[[noreturn]] void refuse_to_read(const std::filesystem::path& path, const std::string& reason) {
  throw FileError("the recording " + path.string() + " cannot be read: " + reason);
}

std::string reason_of(int error) { return std::generic_category().message(error); }

}  // namespace

FileBytes::FileBytes(std::filesystem::path path) : path_(std::move(path)) {
  // Opens without blocking, so that a pipe without a writer is refused below.
  descriptor_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) refuse_to_read(path_, reason_of(errno));
  struct stat status {};
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(descriptor_);
    refuse_to_read(path_, "it is not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() { close(descriptor_); }

void FileBytes::read(std::uint64_t offset, std::span<std::byte> to) const {
  if (offset > size_ || to.size() > size_ - offset)
    at(offset).fail("expected " + std::to_string(to.size()) + " bytes here; the file ends at byte " +
                    std::to_string(size_));
  while (!to.empty()) {
    const ssize_t count = pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) at(offset).fail("it cannot be read: " + reason_of(errno));
    if (count == 0) at(offset).fail("the file ends here; it had " + std::to_string(size_) + " bytes before");
    to = to.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

Bytes FileBytes::read(std::uint64_t offset, std::uint64_t size) const {
  if (offset > size_ || size > size_ - offset)
    at(offset).fail("expected " + std::to_string(size) + " bytes here; the file ends at byte " + std::to_string(size_));
  Bytes bytes(static_cast<std::size_t>(size));
  read(offset, std::span(bytes));
  return bytes;
}

std::uint32_t FileBytes::crc(std::uint64_t from, std::uint64_t to) const {
  constexpr std::uint64_t piece = 1U << 20U;
  Bytes bytes(static_cast<std::size_t>(std::min(piece, to - from)));
  std::uint32_t crc = 0;
  while (from < to) {
    const std::span part = std::span(bytes).first(static_cast<std::size_t>(std::min(piece, to - from)));
    read(from, part);
    crc = crc32(part, crc);
    from += part.size();
  }
  return crc;
}

ByteView FileWindow::peek(std::uint64_t offset, std::size_t size) {
  if (offset >= file_.size()) return {};
  size = static_cast<std::size_t>(std::min<std::uint64_t>(size, file_.size() - offset));
  if (offset < start_ || offset - start_ > bytes_.size() || bytes_.size() - (offset - start_) < size) {
    constexpr std::size_t ahead = 64U << 10U;
    const std::uint64_t wanted = std::max(size, ahead);
    bytes_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(wanted, file_.size() - offset)));
    start_ = offset;
    file_.read(offset, bytes_);
  }
  return ByteView(bytes_).subspan(static_cast<std::size_t>(offset - start_), size);
}

ByteView FileWindow::get(std::uint64_t offset, std::uint64_t size) {
  if (offset > file_.size() || size > file_.size() - offset) file_.read(offset, size);  // throws
  return peek(offset, static_cast<std::size_t>(size));
}

}  // namespace cohort::recording
