// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/services/service_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <array>
#include <system_error>
#include <thread>

namespace cohort::bridges::ros2 {
namespace {

using namespace std::chrono_literals;

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

pid_t start(const std::vector<std::string>& command, int stream) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, stream, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, stream, STDOUT_FILENO);
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, arguments.front(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(error, command.front());
  return pid;
}

}  // namespace

ServiceProcess::ServiceProcess(const std::vector<std::string>& command) {
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) fail(errno, "socketpair");
  socket_ = Descriptor(sockets[0]);
  const Descriptor of_helper(sockets[1]);
  pid_ = start(command, of_helper.number());
}

ServiceProcess::~ServiceProcess() {
  socket_ = Descriptor();
  const auto deadline = std::chrono::steady_clock::now() + 2s;
  while (::waitpid(pid_, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
      return;
    }
    std::this_thread::sleep_for(5ms);
  }
}

void ServiceProcess::send(const FrameToHelper& frame) {
  const std::string bytes = encode(frame);
  std::size_t sent = 0;
  while (socket_.is_open() && sent < bytes.size()) {
    const ssize_t more = ::send(socket_.number(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (more >= 0)
      sent += static_cast<std::size_t>(more);
    else if (!is_for_later(errno))
      socket_ = Descriptor();
  }
}

std::optional<FrameToBridge> ServiceProcess::receive(std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (;;) {
    if (auto frame = stream_.next()) return frame;
    if (!socket_.is_open()) return {};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd waiting{.fd = socket_.number(), .events = POLLIN, .revents = 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(std::max(left, 0ms).count()));
    if (ready > 0)
      read_what_is_there();
    else if (left <= 0ms)
      return {};
  }
}

void ServiceProcess::read_what_is_there() {
  std::array<char, 65536> buffer;
  const ssize_t size = ::recv(socket_.number(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (size > 0)
    stream_.append({buffer.data(), static_cast<std::size_t>(size)});
  else if (size == 0 || !is_for_later(errno))
    socket_ = Descriptor();
}

}  // namespace cohort::bridges::ros2
