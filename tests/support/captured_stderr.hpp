// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

namespace cohort::test {

/// Captures the standard error of this process during its lifetime. Unlike GoogleTest's capture, it can be read while
/// it captures.
class CapturedStderr {
 public:
  CapturedStderr() : kept_(::dup(STDERR_FILENO)), file_(std::tmpfile()) {
    std::fflush(stderr);
    ::dup2(::fileno(file_), STDERR_FILENO);
  }
  CapturedStderr(const CapturedStderr&) = delete;
  CapturedStderr& operator=(const CapturedStderr&) = delete;
  ~CapturedStderr() {
    std::fflush(stderr);
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
    std::fclose(file_);
  }

  std::string text() const {
    std::fflush(stderr);
    std::string result(static_cast<std::size_t>(::lseek(STDERR_FILENO, 0, SEEK_CUR)), '\0');
    const ssize_t size = ::pread(::fileno(file_), result.data(), result.size(), 0);
    result.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return result;
  }
  bool contains(const std::string& part) const { return text().find(part) != std::string::npos; }

 private:
  int kept_;
  std::FILE* file_;
};

}  // namespace cohort::test
