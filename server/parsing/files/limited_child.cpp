// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/limited_child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <new>
#include <system_error>

#include "server/core/thread_room.hpp"

namespace cohort::parsing {
namespace {

// Exit codes of a child that is not ended by a signal.
constexpr int has_finished = 0;
constexpr int is_out_of_memory = 70;
constexpr int cannot_be_limited = 71;
constexpr int has_thrown = 72;
constexpr int cannot_be_copied = 73;

// ---- In the child ----

// Returns the size of the address space of this process [bytes]; 0 if it is unknown.
std::uint64_t address_space() {
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  std::array<char, 128> text{};
  const ssize_t size = read(file, text.data(), text.size() - 1);
  close(file);
  return size <= 0 ? 0 : std::strtoull(text.data(), nullptr, 10) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

bool limit(int resource, rlim_t soft, rlim_t hard) {
  rlimit now{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) return false;
  const rlimit then{std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
  return setrlimit(static_cast<__rlimit_resource>(resource), &then) == 0;
}

// AddressSanitizer and ThreadSanitizer allocate within memory that they have reserved, so there the memory limit has no
// effect.
bool set_limits(const ChildLimits& limits) {
  const std::uint64_t shared = address_space();
  const auto seconds = static_cast<rlim_t>(limits.processor_time.count());
  alarm(static_cast<unsigned>(limits.wall_time.count()));
  std::set_new_handler([] { _exit(is_out_of_memory); });
  return shared > 0 && limit(RLIMIT_AS, shared + limits.memory, shared + limits.memory) &&
         limit(RLIMIT_CPU, seconds, seconds + 1);  // at the hard limit the signal is SIGKILL, which is less specific
}

// Resets signals: handlers of the parent must not run for a crash of the child, and only the parent handles signals
// from the terminal.
void leave_signals_of_parent() {
  for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  setpgid(0, 0);
}

// Moves `socket` to another number, which it returns, and closes all other files. Standard error stays, since the C
// library reports heap corruption there.
int leave_files_of_parent(int socket) {
  socket = fcntl(socket, F_DUPFD_CLOEXEC, 3);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int standard = 0; standard < 3; ++standard) {
    if (nothing < 0) close(standard);
    if (nothing >= 0 && nothing != standard) dup2(nothing, standard);
  }
  const auto kept = static_cast<unsigned>(socket);
  if (kept > 3) close_range(3, kept - 1, 0);
  close_range(kept + 1, ~0u, 0);
  return socket;
}

void die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(cannot_be_limited);  // it has died meanwhile
}

// The process ends without destructors, which are the parent's.
[[noreturn]] void do_work(ChildStream& stream, const ChildLimits& limits, const LimitedChild::Work& work) {
  if (!set_limits(limits)) _exit(cannot_be_limited);
  try {
    work(stream);
  } catch (...) {
    _exit(has_thrown);
  }
  _exit(has_finished);
}

// Ends this process as one with this status has ended.
[[noreturn]] void end_like(int status) {
  if (WIFSIGNALED(status)) kill(getpid(), WTERMSIG(status));
  _exit(WIFEXITED(status) ? WEXITSTATUS(status) : has_thrown);
}

[[noreturn]] void do_work_many_times(ChildStream& stream, const ChildLimits& limits, const LimitedChild::Work& work) {
  try {
    while (true) {
      stream.receive<char>();
      const pid_t parent = getpid();
      const pid_t copy = fork();
      if (copy < 0) _exit(cannot_be_copied);
      if (copy == 0) {
        die_with(parent);
        do_work(stream, limits, work);
      }
      int status = 0;
      while (waitpid(copy, &status, 0) < 0 && errno == EINTR) continue;
      if (status != 0) end_like(status);
    }
  } catch (const ChildStream::Lost&) {  // no more work
    _exit(has_finished);
  }
}

[[noreturn]] void be_child(int socket, pid_t parent, const ChildLimits& limits, const LimitedChild::Work& work,
                           LimitedChild::Times times) {
  die_with(parent);
  prctl(PR_SET_DUMPABLE, 0);  // no core files
  leave_signals_of_parent();
  ChildStream stream(leave_files_of_parent(socket));
  if (times == LimitedChild::Times::many) do_work_many_times(stream, limits, work);
  do_work(stream, limits, work);
}

// ---- In the parent ----

std::string text_of(std::uint64_t bytes) {
  constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;
  return bytes % gibibyte == 0 ? std::to_string(bytes / gibibyte) + " GiB" : std::to_string(bytes >> 20) + " MiB";
}
std::string text_of(std::chrono::seconds time) { return std::to_string(time.count()) + " s"; }

std::string why_ended(int status, const ChildLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    if (number == SIGXCPU) return "used more than " + text_of(limits.processor_time) + " of processor time";
    if (number == SIGALRM) return "took longer than " + text_of(limits.wall_time);
    return "crashed (signal " + std::to_string(number) + ")";
  }
  const int code = WEXITSTATUS(status);
  if (code == is_out_of_memory) return "needed more than " + text_of(limits.memory) + " of memory";
  if (code == cannot_be_limited)
    return "could not be started with limits on its memory and time; check that /proc is mounted";
  if (code == cannot_be_copied) return "could not be started; check the limits of processes (ulimit -u) and of memory";
  return "crashed (exit code " + std::to_string(code) + ")";
}

}  // namespace

ChildStream::~ChildStream() { close(socket_); }

// NOLINTNEXTLINE(readability-make-member-function-const): it changes what the other end receives
void ChildStream::send(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t count = ::send(socket_, at, size, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Lost();
    at += count;
    size -= static_cast<std::size_t>(count);
  }
}

// NOLINTNEXTLINE(readability-make-member-function-const): it takes what the other end has sent
void ChildStream::receive(void* bytes, std::size_t size) {
  char* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t count = recv(socket_, at, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Lost();
    at += count;
    size -= static_cast<std::size_t>(count);
  }
}

LimitedChild::Ends::Ends() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot start a process");
  of_parent = ends[0];
  of_child = ends[1];
}

LimitedChild::LimitedChild(const ChildLimits& limits, const Work& work, Times times)
    : LimitedChild(Ends(), limits, work, times) {}

LimitedChild::LimitedChild(Ends ends, const ChildLimits& limits, const Work& work, Times times)
    : limits_(limits), stream_(ends.of_parent) {
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) be_child(ends.of_child, parent, limits, work, times);
  const int error = errno;
  close(ends.of_child);
  if (process_ < 0 && error == EAGAIN) throw ThreadLimit("a process");
  if (process_ < 0) throw std::system_error(error, std::generic_category(), "cannot start a process");
}

LimitedChild::~LimitedChild() {
  if (process_ > 0) end();
}

// If a process is already exiting, which closes its stream, killing it does not change its exit status.
std::string LimitedChild::end() {
  kill(process_, SIGKILL);
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(process_, &status, 0);
  while (ended < 0 && errno == EINTR);
  process_ = -1;
  // The parent of this process may have set it to ignore the exit of its children.
  return ended < 0 ? "crashed" : why_ended(status, limits_);
}

}  // namespace cohort::parsing
