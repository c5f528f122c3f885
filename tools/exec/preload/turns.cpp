// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/preload/turns.hpp"

#include <errno.h>

#include <utility>

#include "tools/exec/preload/this_program.hpp"

namespace cohort::exec {
namespace {

std::atomic<std::uint32_t> in_line{0};  // threads of this process

// The lock of the interpreter is a flag, with a mutex and a condition variable that is signalled when it is released.
// The interpreter releases it before its second thread begins.
std::atomic<const pthread_mutex_t*> its_mutex{nullptr};
std::atomic<const pthread_cond_t*> its_condition{nullptr};

// Since version 3.11 it reads the clock before it takes any lock of its program; earlier ones do so for time limits.
std::atomic<bool> reads_clock_for_locks{true};

void note_ready() {
  if (the_page->host_looks != 0) return note_change();
  the_page->ready.fetch_add(1);
  futex<std::uint32_t>(the_page->ready, FUTEX_WAKE, 1);
}

void have_turn() {
  if (!has_turns()) return;
  const std::int32_t thread = id_of_thread();
  std::int32_t nobody = 0;
  if (this_process->turn == thread || this_process->turn.compare_exchange_strong(nobody, thread)) return;
  wait_for_turn();
}

}  // namespace

bool has_turns() { return the_page != nullptr && the_page->is_real == 0 && the_page->no_turns == 0; }

void wait_for_turn() {
  if (!has_turns()) return;
  PlaceInLine place(nullptr, never, true);
  while (!place.sleep()) {
  }
}

PlaceInLine::PlaceInLine(const void* object, std::int64_t deadline, bool is_ready) : wait_(wait_of_thread()) {
  in_line.fetch_add(1);
  if (wait_ == nullptr) return;
  wait_->wake = 0;
  wait_->object = object;
  wait_->is_ready = is_ready ? 1 : 0;
  wait_->deadline = deadline;
  wait_->kind = WaitKind::turn;
}

PlaceInLine::~PlaceInLine() {
  in_line.fetch_sub(1);
  if (wait_ == nullptr) return;
  wait_->kind = WaitKind::none;
  wait_->deadline = never;
}

bool PlaceInLine::sleep() {
  if (wait_ == nullptr) return true;
  wait_->is_ready != 0 ? note_ready() : note_change();
  const std::int64_t begin = now();
  // A wait with a limit is one that each handled signal ends.
  const timespec long_time = to_timespec(never);
  bool is_whole = true;
  while (is_whole && wait_->wake == 0 && has_turns()) {
    const long result =
        call_system(SYS_futex, reinterpret_cast<long>(&wait_->wake), FUTEX_WAIT, 0, reinterpret_cast<long>(&long_time));
    is_whole = result == 0 || errno != EINTR;
  }
  if (now() != begin) self.reads = 0;  // it does not spin
  return is_whole;
}

void make_ready(const void* object) {
  if (in_line == 0) return;
  const std::int32_t process = this_process->id;
  bool has_any = false;
  for (std::uint32_t i = 0; i < the_page->waits_used; ++i) {
    Wait& wait = the_page->waits[i];
    if (wait.process != process || wait.kind != WaitKind::turn || wait.object != object) continue;
    wait.is_ready = 1;
    has_any = true;
  }
  if (has_any) note_ready();
}

void forget_turns() {
  in_line = 0;
  self.interpreter_mutexes = 0;
}

void before_lock(const pthread_mutex_t* mutex) {
  if (mutex == its_mutex) {
    if (!self.has_interpreter) have_turn();
    self.has_signalled = false;
  } else if (its_mutex == nullptr && self.interpreter_mutexes++ == 0) {
    self.first_mutex = mutex;
  }
}

void before_signal(const pthread_cond_t* condition) {
  if (its_condition == nullptr && self.interpreter_mutexes == 1) {
    its_mutex = static_cast<const pthread_mutex_t*>(self.first_mutex);
    its_condition = condition;
  }
  if (condition != its_condition) return;
  self.has_signalled = true;
  make_ready(condition);
}

void before_unlock(const pthread_mutex_t* mutex) {
  if (mutex == its_mutex)
    self.has_interpreter = !self.has_signalled;
  else if (self.interpreter_mutexes > 0)
    --self.interpreter_mutexes;
}

int wait_for_interpreter(pthread_cond_t* condition, pthread_mutex_t* mutex, bool& is_done) {
  is_done = condition == its_condition && has_turns();
  if (!is_done) return 0;
  const auto lock = next_of<"pthread_mutex_lock", decltype(&::pthread_mutex_lock)>();
  const auto unlock = next_of<"pthread_mutex_unlock", decltype(&::pthread_mutex_unlock)>();
  {
    PlaceInLine place(condition, never, false);
    unlock(mutex);
    while (!place.sleep()) {
    }
  }
  lock(mutex);
  return has_turns() ? 0 : ETIMEDOUT;
}

void after_read_of_clock() { self.has_read_clock = true; }

void after_try_to_take(bool is_taken) {
  if (!std::exchange(self.has_read_clock, false)) reads_clock_for_locks = false;
  if (is_taken && reads_clock_for_locks && self.reads > 0) --self.reads;
}

}  // namespace cohort::exec
