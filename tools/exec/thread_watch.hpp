// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace cohort::exec {

/// Returns whether the system call with this number sleeps by the machine's clock.
bool is_sleep(long number);

/// Observes in /proc whether all threads of some processes wait. Not thread-safe.
class ThreadWatch {
 public:
  ThreadWatch() = default;
  ~ThreadWatch();
  ThreadWatch(const ThreadWatch&) = delete;
  ThreadWatch& operator=(const ThreadWatch&) = delete;

  /// Sets the processes to watch, with their present threads except `except`.
  void look_at(const std::vector<pid_t>& processes, pid_t except = 0);

  /// Returns whether every thread waits in the kernel, and none has run during this check.
  bool all_wait();
  /// Returns whether a thread has ended since look_at, which must then be called again.
  bool has_changed() const { return has_changed_; }
  /// Returns the processor time of the threads that all_wait has seen, as far as the kernel provides it.
  std::chrono::nanoseconds processor_time() const;
  /// Returns the number of watched processes.
  std::size_t process_count() const { return processes_; }

  /// Returns the living processes that the threads have started.
  std::vector<pid_t> children();

  /// Returns a message to the user that names the threads which do not wait.
  std::string busy_threads();

  struct SystemCall {
    pid_t process = 0;
    pid_t thread = 0;
    long number = -1;
    std::uint64_t arguments[6]{};
  };
  /// Returns whether all_wait has seen a thread sleep by the machine's clock, as far as the kernel shows it.
  bool sleeps(pid_t thread) const;
  /// Returns the system calls in which threads wait, as far as the kernel shows them.
  std::vector<SystemCall> system_calls() const;

 private:
  struct Thread {
    pid_t process = 0;
    int stat = -1;         // descriptors
    int schedstat = -1;    // -1: not supported by the kernel
    int children = -1;     // likewise
    int system_call = -1;  // likewise
    std::string ran{};     // contents of schedstat
    bool rests = false;    // was seen waiting for something other than a file since it ran last
    bool sleeps = false;   // this wait is a sleep by the machine's clock
  };
  static void close_all(Thread& thread);
  bool note_run(Thread& thread);
  bool waits(const Thread& thread);
  bool rests(Thread& thread) const;

  std::map<pid_t, Thread> threads_;
  std::size_t processes_ = 0;
  bool has_changed_ = false;
};

}  // namespace cohort::exec
