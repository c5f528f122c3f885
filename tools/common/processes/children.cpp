// SPDX-License-Identifier: Apache-2.0
#include "tools/common/processes/children.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include "server/core/thread_room.hpp"
#include "tools/common/processes/external_program.hpp"

namespace cohort::tool {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds patience{2};
constexpr std::chrono::milliseconds poll_interval{100};  // used if the kernel does not announce a child's end
constexpr std::size_t longest_line = std::size_t{64} * 1024;

int open_pidfd(pid_t pid) { return static_cast<int>(syscall(SYS_pidfd_open, pid, 0)); }

// Returns the text of strsignal, which need not be thread-safe.
std::string description_of(int signal_number) {
  if (const char* description = sigdescr_np(signal_number); description != nullptr) return description;
  if (signal_number < SIGRTMIN) return "Unknown signal " + std::to_string(signal_number);
  return "Real-time signal " + std::to_string(signal_number - SIGRTMIN);
}

std::string end_of(const Children::Command& command, pid_t pid, int status) {
  const std::string process = (command.is_controller ? "controller process " : "process ") + std::to_string(pid);
  if (!WIFSIGNALED(status)) return process + " ended with exit code " + std::to_string(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  return process + " was terminated by signal " + std::to_string(number) + " (" + description_of(number) + ")";
}

// Runs between fork and exec, where only functions that are safe in a signal handler may be called.
[[noreturn]] void become(char* const* arguments, pid_t parent, int standard_error) {
  // The parent here is the thread that forked: the watcher, which outlives all children.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent died meanwhile
  setpgid(0, 0);                        // Ctrl-C goes to the parent, which ends the run in order
  // A read from the terminal would stop a background process.
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  if (standard_error >= 0) dup2(standard_error, STDERR_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);  // standard output has the parent's results only
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  execv(arguments[0], arguments);
  _exit(127);
}

// Returns a timeout for poll: -1 means no limit, and 0 only that the deadline has passed.
int poll_timeout(Clock::time_point deadline, bool all_announced) {
  if (deadline == Clock::time_point::max()) return all_announced ? -1 : static_cast<int>(poll_interval.count());
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
  if (left.count() <= 0) return 0;
  return static_cast<int>(all_announced ? left.count() : std::min(left, poll_interval).count());
}

}  // namespace

Children::Children(std::vector<Command> commands, Listener listener) : listener_(std::move(listener)) {
  if (pipe2(wake_pipe_, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  signal(SIGCHLD, SIG_DFL);  // the starting process may have ignored it, and then waiting for children fails
  for (Command& command : commands) children_.push_back({std::move(command)});
  watcher_ = std::thread([this] { watch(); });
}

Children::~Children() {
  join();
  close(wake_pipe_[0]);
  close(wake_pipe_[1]);
}

void Children::let_finish() {
  patient_ = true;
  join();
}

void Children::join() {
  if (!watcher_.joinable()) return;
  finishing_ = true;
  [[maybe_unused]] const auto written = write(wake_pipe_[1], "", 1);
  watcher_.join();
}

// NOLINTNEXTLINE(readability-make-member-function-const): the child that it changes is one of ours.
void Children::start(Child& child) {
  const std::vector<char*> arguments = arguments_of(child.command.arguments);
  int output[2] = {-1, -1};
  const bool piped = listener_.wrote && pipe2(output, O_CLOEXEC | O_NONBLOCK) == 0;
  if (piped) fcntl(output[1], F_SETFL, 0);  // non-blocking mode is for the reading end only
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(arguments.data(), parent, output[1]);
  const int error = errno;
  close_if_open(output[1]);
  child.output = output[0];
  if (pid < 0) {
    close_if_open(child.output);
    if (listener_.gave_up)
      listener_.gave_up(child.command.name + ": " +
                        (error == EAGAIN ? ThreadLimit("a process").what()
                                         : "cannot start a process: " + std::generic_category().message(error)));
    return;
  }
  setpgid(pid, pid);  // parent and child both set it, so the order does not matter
  child.pid = pid;
  child.pidfd = open_pidfd(pid);
  if (listener_.started) listener_.started(child.command, pid);
}

void Children::watch() {
  for (Child& child : children_) start(child);
  while (!finishing_) reap_until(Clock::time_point::max());
  // The run is over: children end by themselves, on SIGTERM, or on SIGKILL.
  if (patient_ && reap_until(Clock::now() + patience)) return;
  signal_all(SIGTERM);
  if (reap_until(Clock::now() + patience)) return;
  for (const Child& child : children_)
    if (child.pid > 0 && listener_.killed)
      listener_.killed(child.command, child.command.name + ": process " + std::to_string(child.pid) +
                                          " did not end on request and was killed");
  signal_all(SIGKILL);
  reap_until(Clock::now() + patience);
}

void Children::signal_all(int number) {
  for (const Child& child : children_)
    if (child.pid > 0) kill(-child.pid, number);
}

// Handles ends and output of children. Returns true when all have ended, false if the deadline passes or finishing
// begins.
bool Children::reap_until(Clock::time_point deadline) {
  const bool was_finishing = finishing_;
  for (;;) {
    std::vector<pollfd> polled;
    if (!was_finishing) polled.push_back({wake_pipe_[0], POLLIN, 0});
    bool any = false;
    bool all_announced = true;
    for (const Child& child : children_) {
      if (child.pid <= 0) continue;
      any = true;
      all_announced = all_announced && child.pidfd >= 0;
      polled.push_back({child.pidfd, POLLIN, 0});
      polled.push_back({child.output, POLLIN, 0});
    }
    if (!any && was_finishing) return true;
    const int timeout = poll_timeout(deadline, all_announced);
    if (timeout == 0) return !any;
    poll(polled.data(), polled.size(), timeout);
    for (Child& child : children_) {
      read_output(child);
      reap(child);
    }
    if (finishing_ && !was_finishing) return false;
  }
}

void Children::reap(Child& child) {
  if (child.pid <= 0) return;
  siginfo_t end{};
  if (waitid(P_PID, static_cast<id_t>(child.pid), &end, WEXITED | WNOHANG | WNOWAIT) != 0 || end.si_pid != child.pid)
    return;
  // Ends the processes that the child started, before its id can be reused.
  kill(-child.pid, SIGKILL);
  int status = 0;
  waitpid(child.pid, &status, 0);
  handle_end(child, status);
}

void Children::handle_end(Child& child, int status) {
  read_output(child);
  if (!child.line.empty()) listener_.wrote(child.command, std::exchange(child.line, {}));
  close_if_open(child.output);
  close_if_open(child.pidfd);
  if (listener_.ended) listener_.ended(child.pid, WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  const std::string text = child.command.name + ": " + end_of(child.command, std::exchange(child.pid, -1), status);
  // A controller must not end during a run, even without an error.
  if (!restarting_ || finishing_) return;
  if (WIFEXITED(status) && listener_.may_end_with && listener_.may_end_with(WEXITSTATUS(status))) return;
  const auto give_up = [&](const std::string& why) {
    if (listener_.gave_up) listener_.gave_up(text + why);
  };
  if (!child.command.restarts)
    return give_up(child.command.is_controller ? "; the experiment specifies 'restart: never'" : "");
  if (child.restarts == most_restarts)
    return give_up("; it had been restarted " + std::to_string(most_restarts) + " times before");
  ++child.restarts;
  if (listener_.restarted)
    listener_.restarted(child.command, text + "; restarting it (" + std::to_string(child.restarts) + " of " +
                                           std::to_string(most_restarts) + ")");
  start(child);
}

// NOLINTNEXTLINE(readability-make-member-function-const): the child that it changes is one of ours.
void Children::read_output(Child& child) {
  if (child.output < 0) return;
  char buffer[4096];
  constexpr int at_once = 16;  // a pipe's capacity: a child that writes without end must not block the others
  for (int i = 0; i < at_once; ++i) {
    const ssize_t size = ::read(child.output, buffer, sizeof buffer);
    if (size == 0) return close_if_open(child.output);
    if (size < 0) return;
    child.line.append(buffer, static_cast<std::size_t>(size));
    for (std::size_t end = 0; (end = child.line.find('\n')) != std::string::npos;) {
      listener_.wrote(child.command, child.line.substr(0, end));
      child.line.erase(0, end + 1);
    }
    if (child.line.size() > longest_line) listener_.wrote(child.command, std::exchange(child.line, {}));
  }
}

}  // namespace cohort::tool
