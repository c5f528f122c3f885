// SPDX-License-Identifier: Apache-2.0
#include "idl/text/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>

#include "idl/text/printable.hpp"

namespace cohort {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a process has one standard output.
std::atomic<int> first_output_error{0};

void note_output_error(int error) {
  int none = 0;
  first_output_error.compare_exchange_strong(none, error);
}

}  // namespace

void open_standard_streams() {
  int opened = -1;
  do {
    opened = ::open("/dev/null", O_RDWR);  // NOLINT(android-cloexec-open): programs that this one starts have them too
  } while (opened >= STDIN_FILENO && opened <= STDERR_FILENO);
  if (opened >= 0) ::close(opened);
}

void outlive_readers() {
  struct sigaction action {};
  ::sigaction(SIGPIPE, nullptr, &action);
  if (action.sa_handler == SIG_IGN) return;
  // Unlike SIG_IGN, a handler does not outlast exec.
  action = {};
  action.sa_handler = [](int) {};
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGPIPE, &action, nullptr);
}

void write_output(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note_output_error(errno);
}

void print_message(std::string_view text) {
  constexpr std::size_t longest = 16'384;
  std::fprintf(stderr, "%s\n", printable(text, longest, Lines::kept).c_str());
}

int flush_output() {
  if (std::fflush(stdout) != 0) note_output_error(errno);
  if (std::ferror(stdout) != 0) note_output_error(EIO);  // written by other code, which did not store the reason
  return first_output_error;
}

}  // namespace cohort
