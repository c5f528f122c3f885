// SPDX-License-Identifier: Apache-2.0
#include "server/core/bounded_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <system_error>

namespace cohort {
namespace {

class OpenedFile {
 public:
  explicit OpenedFile(const std::filesystem::path& file)
      : file_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) refuse(std::generic_category().message(errno));
  }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;
  ~OpenedFile() { ::close(descriptor_); }

  /// Throws if the file is a device, or is known to be longer.
  void expect_at_most(std::size_t most) const {
    struct stat facts {};
    if (::fstat(descriptor_, &facts) != 0) refuse(std::generic_category().message(errno));
    if (S_ISCHR(facts.st_mode) || S_ISBLK(facts.st_mode)) refuse("it is a device");
    if (S_ISREG(facts.st_mode) && static_cast<std::uintmax_t>(facts.st_size) > most) refuse_as_longer(most);
  }

  [[noreturn]] void refuse_as_longer(std::size_t most) const {
    refuse("it is longer than " + std::to_string(most >> 20U) + " MiB, the limit for this kind of file");
  }

  /// Reads up to `size` bytes; 0 at the end.
  std::size_t read(char* to, std::size_t size) const {
    ssize_t count = 0;
    do count = ::read(descriptor_, to, size);
    while (count < 0 && errno == EINTR);
    if (count < 0) refuse(std::generic_category().message(errno));
    return static_cast<std::size_t>(count);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw std::runtime_error("cannot read " + file_.string() + ": " + reason);
  }

  const std::filesystem::path& file_;
  int descriptor_;
};

}  // namespace

std::string read_bounded(const std::filesystem::path& file, std::size_t most) {
  constexpr std::size_t piece = std::size_t{1} << 20U;
  const OpenedFile opened(file);
  opened.expect_at_most(most);
  std::string bytes;
  for (;;) {
    const std::size_t size = bytes.size();
    bytes.resize(size + std::min(piece, most + 1 - size));
    const std::size_t count = opened.read(bytes.data() + size, bytes.size() - size);
    bytes.resize(size + count);
    if (count == 0) return bytes;
    if (bytes.size() > most) opened.refuse_as_longer(most);
  }
}

}  // namespace cohort
