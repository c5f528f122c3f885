#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace cohort::exec {

/// Returns whether a system call's number is that of a sleep by the machine's clock.
bool is_sleep(long number);

/// The threads of processes, as the kernel tells of them in /proc: whether all of them wait. One thread.
class ThreadWatch {
 public:
  ThreadWatch() = default;
  ~ThreadWatch();
  ThreadWatch(const ThreadWatch&) = delete;
  ThreadWatch& operator=(const ThreadWatch&) = delete;

  /// Looks at these processes from now on, and at the threads that they have now, but for the thread `except`.
  void look_at(const std::vector<pid_t>& processes, pid_t except = 0);

  /// Returns whether every thread waits in the kernel, and none has run while this was found out.
  bool all_wait();
  /// Returns whether a thread has ended since look_at, so that it has to be called again.
  bool has_changed() const { return has_changed_; }
  /// Returns the processor time that the threads which all_wait has seen have used, as far as the kernel tells.
  std::chrono::nanoseconds processor_time() const;
  /// Returns how many processes it looks at.
  std::size_t process_count() const { return processes_; }

  /// Returns the processes that the threads have started and that live.
  std::vector<pid_t> children();

  /// Says which threads do not wait, for people.
  std::string busy_threads();

  struct SystemCall {
    pid_t process = 0;
    pid_t thread = 0;
    long number = -1;
    std::uint64_t arguments[6]{};
  };
  /// Returns whether all_wait has seen a thread sleep by the machine's clock, as far as the kernel tells.
  bool sleeps(pid_t thread) const;
  /// Returns what the threads that wait are waiting in, as far as the kernel tells.
  std::vector<SystemCall> system_calls() const;

 private:
  struct Thread {
    pid_t process = 0;
    int stat = -1;         // descriptors
    int schedstat = -1;    // -1: the kernel has none
    int children = -1;     // likewise
    int system_call = -1;  // likewise
    std::string ran{};     // contents of schedstat
    bool rests = false;    // since it ran last, it was seen to wait for something else than a file
    bool sleeps = false;   // then, by the machine's clock
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
