// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/thread_watch.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <set>
#include <sstream>
#include <string_view>

namespace cohort::exec {

bool is_sleep(long number) { return number == SYS_nanosleep || number == SYS_clock_nanosleep; }

namespace {

std::string task_folder(pid_t process) { return "/proc/" + std::to_string(process) + "/task/"; }

// Returns what is at the beginning of a file of /proc; empty if its process is gone.
std::string_view read_again(int file, std::array<char, 512>& buffer) {
  const ssize_t size = ::pread(file, buffer.data(), buffer.size(), 0);
  return {buffer.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
}

// In `stat` the state follows the name, which is in parentheses and may hold any character.
char state_in(std::string_view stat) {
  const auto end_of_name = stat.rfind(')');
  return end_of_name == std::string_view::npos || end_of_name + 2 >= stat.size() ? '?' : stat[end_of_name + 2];
}

std::string name_in(std::string_view stat) {
  const auto begin = stat.find('(');
  const auto end = stat.rfind(')');
  return begin == std::string_view::npos || end == std::string_view::npos
             ? std::string()
             : std::string(stat.substr(begin + 1, end - begin - 1));
}

// Asleep until something comes, or ended. A process that a debugger has stopped does not count: its time waits.
bool is_waiting(char state) { return state == 'S' || state == 'I' || state == 'Z' || state == 'X'; }

// From the contents of `syscall`: a number and six arguments, or a word if there is no call.
ThreadWatch::SystemCall system_call_in(std::string_view text) {
  ThreadWatch::SystemCall call;
  std::istringstream words{std::string(text)};
  if (!(words >> call.number)) call.number = -1;
  for (std::uint64_t& argument : call.arguments) {
    std::string word;
    if (!(words >> word)) break;
    argument = std::stoull(word, nullptr, 16);
  }
  return call;
}

// Calls that wait for other threads, processes, machines or the time.
bool waits_for_others(long number) {
  switch (number) {
    case SYS_futex:
    case SYS_ppoll:
    case SYS_pselect6:
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
    case SYS_read:
    case SYS_readv:
    case SYS_write:
    case SYS_writev:
    case SYS_recvfrom:
    case SYS_recvmsg:
    case SYS_recvmmsg:
    case SYS_sendto:
    case SYS_sendmsg:
    case SYS_accept:
    case SYS_accept4:
    case SYS_connect:
    case SYS_wait4:
    case SYS_waitid:
    case SYS_nanosleep:
    case SYS_clock_nanosleep:
    case SYS_rt_sigsuspend:
    case SYS_rt_sigtimedwait:
    case SYS_restart_syscall:
    case SYS_semtimedop:
    case SYS_msgrcv:
    case SYS_mq_timedreceive:
    case SYS_flock:
#ifdef SYS_poll  // which not every architecture has
    case SYS_poll:
    case SYS_select:
    case SYS_epoll_wait:
    case SYS_pause:
    case SYS_semop:
#endif
    case SYS_io_getevents: return true;
    default: return false;
  }
}

}  // namespace

ThreadWatch::~ThreadWatch() {
  for (auto& [id, thread] : threads_) close_all(thread);
}

void ThreadWatch::close_all(Thread& thread) {
  for (int* file : {&thread.stat, &thread.schedstat, &thread.children, &thread.system_call})
    if (*file >= 0) ::close(*file);
}

void ThreadWatch::look_at(const std::vector<pid_t>& processes, pid_t except) {
  has_changed_ = false;
  processes_ = processes.size();
  std::set<pid_t> there;
  for (const pid_t process : processes) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(task_folder(process), error)) {
      const pid_t id = std::stoi(entry.path().filename().string());
      if (id == except) continue;
      there.insert(id);
      if (threads_.contains(id)) continue;
      Thread thread{.process = process};
      thread.stat = ::open((entry.path() / "stat").c_str(), O_RDONLY | O_CLOEXEC);
      if (thread.stat < 0) continue;
      thread.schedstat = ::open((entry.path() / "schedstat").c_str(), O_RDONLY | O_CLOEXEC);
      thread.system_call = ::open((entry.path() / "syscall").c_str(), O_RDONLY | O_CLOEXEC);
      thread.children = ::open((entry.path() / "children").c_str(), O_RDONLY | O_CLOEXEC);
      threads_.emplace(id, std::move(thread));
    }
  }
  for (auto each = threads_.begin(); each != threads_.end();) {
    if (there.contains(each->first)) {
      ++each;
      continue;
    }
    close_all(each->second);
    each = threads_.erase(each);
  }
}

// How long and how often the thread ran. Returns whether that has changed.
bool ThreadWatch::note_run(Thread& thread) {
  std::array<char, 512> buffer{};
  const std::string_view ran = read_again(thread.schedstat >= 0 ? thread.schedstat : thread.stat, buffer);
  if (ran.empty()) has_changed_ = true;
  if (ran == thread.ran) return false;
  thread.ran = ran;
  thread.rests = false;
  thread.sleeps = false;
  return true;
}

bool ThreadWatch::waits(const Thread& thread) {
  std::array<char, 512> buffer{};
  const std::string_view stat = read_again(thread.stat, buffer);
  if (stat.empty()) has_changed_ = true;
  return stat.empty() || is_waiting(state_in(stat));
}

// A thread that waits for a file system in user space or on the network sleeps like one that waits for the program
// itself. Only the present call tells them apart. Where the kernel does not say it, the thread is taken to rest.
bool ThreadWatch::rests(Thread& thread) const {
  if (thread.rests) return true;
  std::array<char, 512> buffer{};
  const std::string_view text = read_again(thread.system_call, buffer);
  if (!text.empty()) {
    const SystemCall call = system_call_in(text);
    if (!waits_for_others(call.number)) return false;
    thread.sleeps = is_sleep(call.number);
    if (call.number == SYS_read || call.number == SYS_readv) {
      std::error_code error;
      const std::filesystem::path file =
          "/proc/" + std::to_string(thread.process) + "/fd/" + std::to_string(call.arguments[0]);
      if (std::filesystem::is_regular_file(file, error)) return false;
    }
  }
  thread.rests = true;
  return true;
}

// A thread that is seen to wait may be woken by one that is looked at later, which then has run in between.
bool ThreadWatch::all_wait() {
  for (auto& [id, thread] : threads_) note_run(thread);
  for (const auto& [id, thread] : threads_)
    if (!waits(thread)) return false;
  for (auto& [id, thread] : threads_)
    if (!rests(thread)) return false;
  for (auto& [id, thread] : threads_)
    if (note_run(thread)) return false;
  return !has_changed_;
}

// The first number of schedstat.
std::chrono::nanoseconds ThreadWatch::processor_time() const {
  std::int64_t all = 0;
  for (const auto& [id, thread] : threads_) {
    std::int64_t one = 0;
    if (thread.schedstat >= 0) std::from_chars(thread.ran.data(), thread.ran.data() + thread.ran.size(), one);
    all += one;
  }
  return std::chrono::nanoseconds(all);
}

std::vector<pid_t> ThreadWatch::children() {
  std::vector<pid_t> all;
  for (const auto& [id, thread] : threads_) {
    std::array<char, 512> buffer{};
    std::string_view list = read_again(thread.children, buffer);
    while (!list.empty()) {
      const auto end = std::min(list.find(' '), list.size());
      pid_t child = 0;
      if (std::from_chars(list.data(), list.data() + end, child).ec == std::errc()) all.push_back(child);
      list.remove_prefix(std::min(end + 1, list.size()));
    }
  }
  return all;
}

std::string ThreadWatch::busy_threads() {
  std::string text;
  for (const auto& [id, thread] : threads_) {
    std::array<char, 512> buffer{};
    const std::string_view stat = read_again(thread.stat, buffer);
    if (stat.empty() || is_waiting(state_in(stat))) continue;
    const char state = state_in(stat);
    text += (text.empty() ? "" : ", ") + ("'" + name_in(stat) + "' (thread ") + std::to_string(id) + ", " +
            (state == 'R'                   ? "running"
             : state == 'T' || state == 't' ? "stopped"
                                            : "in the kernel") +
            ")";
  }
  return text;
}

bool ThreadWatch::sleeps(pid_t thread) const {
  const auto found = threads_.find(thread);
  return found != threads_.end() && found->second.sleeps;
}

std::vector<ThreadWatch::SystemCall> ThreadWatch::system_calls() const {
  std::vector<SystemCall> calls;
  for (const auto& [id, thread] : threads_) {
    std::array<char, 512> buffer{};
    const std::string_view text = read_again(thread.system_call, buffer);
    if (text.empty()) continue;
    SystemCall call = system_call_in(text);
    call.process = thread.process;
    call.thread = id;
    calls.push_back(call);
  }
  return calls;
}

}  // namespace cohort::exec
