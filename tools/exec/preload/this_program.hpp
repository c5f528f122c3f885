// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>

#include "tools/exec/preload/virtual_clock.hpp"

/// Facts about the program that has loaded this library, used only inside the library.
namespace cohort::exec {

extern ClockPage* the_page;  // nullptr in a program that runs in real time
extern Process* this_process;

struct Thread {
  Wait* wait;
  std::uint64_t order;
  bool has_order;
  bool is_of_dds;
  bool creates_threads_of_dds;
  bool is_helper;
  int uses_real_time;  // nesting depth
  bool has_slept_really;
  std::uint32_t reads;
  int event;  // descriptor + 1; 0: none
  std::int64_t overridden;
  std::int32_t id;  // 0: not yet known
  // Facts about the Python interpreter: how many of its mutexes this thread has locked, and the first of them.
  int interpreter_mutexes;
  const void* first_mutex;
  bool has_signalled;    // that it releases the interpreter's lock
  bool has_interpreter;  // has that lock
  bool has_read_clock;   // since it last tried to take a lock of the program
  struct Verdict {
    const void* caller;
    std::uint8_t what;  // bits: 1 known, 2 DDS, 4 this library, 8 the interpreter
  } verdicts[256];
};
extern __thread Thread self __attribute__((tls_model("initial-exec")));

inline long call_system(long number, long a = 0, long b = 0, long c = 0, long d = 0, long e = 0, long f = 0) {
  using Function = long (*)(long, ...);
  static const auto real = next<Function>("syscall");
  return real(number, a, b, c, d, e, f);
}

template <class Word>
long futex(std::atomic<Word>& word, int operation, Word value) {
  return call_system(SYS_futex, reinterpret_cast<long>(&word), operation, static_cast<long>(value));
}

inline std::int32_t id_of_thread() {
  if (self.id == 0) self.id = static_cast<std::int32_t>(call_system(SYS_gettid));
  return self.id;
}

/// Enters this process into the page, unless its parent has already done so.
void enter_process();
/// Returns the calling thread's rank among threads whose waits end at the same time. Assigns it at the first call.
std::uint64_t order_of_thread();
/// Returns the calling thread's wait in the page; nullptr if there are too many.
Wait* wait_of_thread();
/// Tells the host that a thread begins to wait.
void note_change();
/// Drops the waits in the child of a fork, because they are the parent's.
void forget_waits();
/// Called when the calling thread ends.
void leave_thread();

}  // namespace cohort::exec
