#include "tools/cohort/children.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>

namespace cohort::tool {
namespace {

constexpr std::chrono::seconds patience{2};

int open_pidfd(pid_t pid) { return static_cast<int>(syscall(SYS_pidfd_open, pid, 0)); }

std::string describe(const std::vector<std::string>& command, pid_t pid, int status) {
  std::string text = "controller process " + std::to_string(pid) + " (";
  for (std::size_t i = 1; i < command.size(); ++i) text += (i > 1 ? " " : "") + command[i];
  text += WIFSIGNALED(status) ? ") was ended by signal " + std::to_string(WTERMSIG(status))
                              : ") ended with exit code " + std::to_string(WEXITSTATUS(status));
  return text;
}

}  // namespace

Children::Children(std::vector<std::vector<std::string>> commands, Listener listener) : listener_(std::move(listener)) {
  if (pipe2(wake_pipe_, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  for (auto& command : commands) children_.push_back({std::move(command)});
  // The watcher starts them: a child's parent-death signal follows the thread that started it, and this one stays until
  // the last child is gone.
  watcher_ = std::thread([this] { watch(); });
}

Children::~Children() {
  let_finish();
  close(wake_pipe_[0]);
  close(wake_pipe_[1]);
}

void Children::let_finish() {
  if (!watcher_.joinable()) return;
  finishing_ = true;
  [[maybe_unused]] const auto written = write(wake_pipe_[1], "", 1);
  watcher_.join();
}

void Children::start(Child& child) {
  std::vector<char*> arguments;
  for (std::string& argument : child.command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);  // it died meanwhile
    setpgid(0, 0);                        // Ctrl-C is for the parent, which then ends the run in order
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  if (pid < 0) {
    listener_.gave_up("no process could be started: " + std::generic_category().message(errno));
    return;
  }
  child.pid = pid;
  child.pidfd = open_pidfd(pid);
}

void Children::watch() {
  for (Child& child : children_) start(child);
  while (!finishing_) reap_until(std::chrono::steady_clock::time_point::max());
  // The run is over: they leave by themselves, or are told to, or are made to.
  if (reap_until(std::chrono::steady_clock::now() + patience)) return;
  for (const Child& child : children_)
    if (child.pid > 0) kill(child.pid, SIGTERM);
  if (reap_until(std::chrono::steady_clock::now() + patience)) return;
  for (const Child& child : children_)
    if (child.pid > 0) kill(child.pid, SIGKILL);
  reap_until(std::chrono::steady_clock::now() + patience);
}

// Handles ends of children until all are gone (true), the deadline is over, or finishing begins.
bool Children::reap_until(std::chrono::steady_clock::time_point deadline) {
  const bool was_finishing = finishing_;
  for (;;) {
    std::vector<pollfd> polled;
    if (!was_finishing) polled.push_back({wake_pipe_[0], POLLIN, 0});
    bool any = false;
    for (const Child& child : children_) {
      if (child.pid <= 0) continue;
      polled.push_back({child.pidfd, POLLIN, 0});
      any = true;
    }
    if (!any && was_finishing) return true;
    int timeout = -1;
    if (deadline != std::chrono::steady_clock::time_point::max()) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return !any;
      timeout = static_cast<int>(left.count());
    }
    poll(polled.data(), polled.size(), timeout);
    for (Child& child : children_) {
      int status = 0;
      if (child.pid > 0 && waitpid(child.pid, &status, WNOHANG) == child.pid) handle_end(child, status);
    }
    if (finishing_ && !was_finishing) return false;
  }
}

void Children::handle_end(Child& child, int status) {
  const std::string text = describe(child.command, child.pid, status);
  close(child.pidfd);
  child.pid = -1;
  child.pidfd = -1;
  const bool failed = !WIFEXITED(status) || WEXITSTATUS(status) != 0;
  if (!failed || !restarting_ || finishing_) return;
  if (child.restarts == most_restarts) {
    listener_.gave_up(text + ", and was restarted " + std::to_string(most_restarts) + " times before");
    return;
  }
  ++child.restarts;
  listener_.restarted(text + "; starting it again");
  start(child);
}

}  // namespace cohort::tool
