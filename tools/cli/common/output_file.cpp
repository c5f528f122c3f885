// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "idl/text/standard_streams.hpp"
#include "server/core/atomic_file.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/log.hpp"

namespace cohort::tool {
namespace {

[[noreturn]] void refuse(std::string_view what, const std::filesystem::path& file, int error) {
  refuse_to_write(fmt::format("{} cannot be written to {}", what, file.string()), error);
}

}  // namespace

void check_writable(std::string_view what, const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) refuse(what, file, EISDIR);
  if (std::filesystem::exists(file, ignored)) {  // not opened: it may be a pipe with a reader
    if (access(file.c_str(), W_OK) != 0) refuse(what, file, errno);
    return;
  }
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(what, file, errno);
  close(descriptor);
  std::filesystem::remove(std::filesystem::canonical(file, ignored), ignored);
}

void write_file(std::string_view what, const std::filesystem::path& file, std::string_view contents) {
  AtomicFile out(what, file);
  out.write(contents);
  out.commit();
}

int code_after_output(int code, Log& log) {
  const int error = flush_output();
  if (error == 0 || error == EPIPE) return code;
  log.error("standard output cannot be written: " + why_not_written(error));
  return code == exit_ok ? exit_failed : code;
}

}  // namespace cohort::tool
