// SPDX-License-Identifier: Apache-2.0
#include "tools/common/processes/connected_program.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/common/processes/external_program.hpp"

namespace cohort::tool {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int stop_interval = 100;          // [ms]; interval at which `stop` is read
constexpr std::size_t most_printed = 4096;  // bytes that are kept
constexpr int first_free_descriptor = 64;   // above the descriptors of a program

[[noreturn]] void throw_errno(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

// Runs between fork and exec, where only functions that are safe in a signal handler may be called.
[[noreturn]] void become(char* const* arguments, char* const* environment, const int* descriptors, std::size_t count,
                         int socket, int output, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent died meanwhile
  setpgid(0, 0);
  // Moves both out of the way of the descriptors that they become.
  socket = fcntl(socket, F_DUPFD_CLOEXEC, first_free_descriptor);
  output = fcntl(output, F_DUPFD_CLOEXEC, first_free_descriptor);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  for (std::size_t i = 0; i < count; ++i) dup2(socket, descriptors[i]);
  signal(SIGPIPE, SIG_DFL);
  execve(arguments[0], arguments, environment);
  _exit(127);
}

// Returns the environment of this process with changes, `NAME=VALUE` each.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
  std::vector<std::string> environment = variables;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string variable = *each;
    const std::string name = variable.substr(0, variable.find('=') + 1);
    if (std::ranges::none_of(variables, [&](const std::string& other) { return other.starts_with(name); }))
      environment.push_back(variable);
  }
  return environment;
}

}  // namespace

std::optional<std::filesystem::path> find_program(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

ConnectedProgram::ConnectedProgram(const std::vector<std::string>& command, const std::vector<int>& descriptors,
                                   const std::atomic<bool>& stop, const std::vector<std::string>& variables)
    : stop_(stop), name_(std::filesystem::path(command.front()).filename().string()) {
  const std::vector<char*> arguments = arguments_of(command);
  const std::vector<std::string> environment = environment_with(variables);
  const std::vector<char*> environment_pointers = arguments_of(environment);
  std::array<int, 2> sockets{};
  std::array<int, 2> outputs{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) throw_errno("socketpair");
  socket_ = sockets[0];
  if (pipe2(outputs.data(), O_CLOEXEC) != 0) {
    ::close(sockets[1]);
    close_if_open(socket_);
    throw_errno("pipe");
  }
  output_ = outputs[0];
  fcntl(output_, F_SETFL, O_NONBLOCK);
  signal(SIGCHLD, SIG_DFL);  // the starting process may have ignored it, and then waiting for children fails
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0)
    become(arguments.data(), environment_pointers.data(), descriptors.data(), descriptors.size(), sockets[1],
           outputs[1], parent);
  const int error = errno;
  ::close(sockets[1]);
  ::close(outputs[1]);
  if (pid_ < 0) {
    close_if_open(socket_);
    close_if_open(output_);
    throw std::system_error(error, std::generic_category(), "cannot start " + name_);
  }
  setpgid(pid_, pid_);  // parent and child both set it, so the order does not matter
}

ConnectedProgram::~ConnectedProgram() {
  close_if_open(socket_);
  reap();
  close_if_open(output_);
}

void ConnectedProgram::send(std::string_view bytes) {
  while (!bytes.empty()) {
    if (wait(true) != Event::writable) continue;
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && errno != EINTR && errno != EAGAIN) fail("ended early");
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::string ConnectedProgram::receive(char end, std::size_t most, std::chrono::seconds patience) {
  const Clock::time_point deadline = Clock::now() + patience;
  std::size_t searched = 0;
  for (;;) {
    const std::size_t found = received_.find(end, searched);
    if (found != std::string::npos) {
      std::string message = received_.substr(0, found);
      received_.erase(0, found + 1);
      return message;
    }
    searched = received_.size();
    if (searched > most) fail("sends a message that is too long");
    if (Clock::now() > deadline) fail("does not respond");
    if (wait(false) != Event::readable) continue;
    std::array<char, 65536> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): recv fills it
    const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) fail("ended early");
    if (count > 0) received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

int ConnectedProgram::finish() {
  shutdown(socket_, SHUT_WR);
  while (!has_ended()) {
    if (stop_) throw Interrupted();
    pollfd printed{output_, POLLIN, 0};
    poll(&printed, 1, stop_interval);
    read_printed();
    // The pipe is closed shortly before the process has ended.
    if ((printed.revents & POLLIN) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  read_printed();
  reap();
  return exit_code_;
}

void ConnectedProgram::close(std::chrono::milliseconds patience) {
  close_if_open(socket_);
  const Clock::time_point deadline = Clock::now() + patience;
  while (!has_ended() && Clock::now() < deadline) {
    read_printed();  // it must not wait for a reader
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  reap();
}

// Waits until the socket can be read or written, and reads what the program prints meanwhile.
ConnectedProgram::Event ConnectedProgram::wait(bool for_writing) {
  if (stop_) throw Interrupted();
  std::array<pollfd, 2> watched = {
      {{socket_, static_cast<short>(for_writing ? POLLOUT : POLLIN), 0}, {output_, POLLIN, 0}}};
  if (poll(watched.data(), watched.size(), stop_interval) <= 0) return Event::none;
  if ((watched[1].revents & POLLIN) != 0) read_printed();
  if (watched[0].revents == 0) return Event::none;
  return for_writing ? Event::writable : Event::readable;
}

void ConnectedProgram::read_printed() {
  std::array<char, 4096> buffer{};
  constexpr int at_once = 16;  // a pipe's capacity
  for (int i = 0; i < at_once; ++i) {
    const ssize_t count = ::read(output_, buffer.data(), buffer.size());
    if (count <= 0) return;
    printed_.append(buffer.data(), static_cast<std::size_t>(count));
    if (printed_.size() > most_printed) printed_.erase(0, printed_.size() - most_printed);
  }
}

bool ConnectedProgram::has_ended() const {
  siginfo_t end{};
  return pid_ <= 0 ||
         (waitid(P_PID, static_cast<id_t>(pid_), &end, WEXITED | WNOHANG | WNOWAIT) == 0 && end.si_pid == pid_);
}

// Kills the rest of the process group before its id can be reused. Waits until all of it has ended, so that files of
// the group can be deleted.
void ConnectedProgram::reap() {
  if (pid_ <= 0) return;
  kill(-pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(2);  // its members may stay zombies
  while (kill(-pid_, 0) == 0 && Clock::now() < deadline) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  pid_ = -1;
  exit_code_ = exit_code_of(status);
}

void ConnectedProgram::fail(const std::string& what) const {
  const std::size_t end = printed_.find_last_not_of('\n');
  const std::size_t line = end == std::string::npos ? end : printed_.rfind('\n', end);
  const std::string last =
      end == std::string::npos ? "" : printed_.substr(line == std::string::npos ? 0 : line + 1, end - line);
  throw std::runtime_error(name_ + " " + what + (last.empty() ? "" : ": " + last));
}

}  // namespace cohort::tool
