// SPDX-License-Identifier: Apache-2.0

// Waits of threads for each other, with a time limit: condition variables; and waits for data of DDS.

#include <errno.h>
#include <threads.h>

#include "tools/exec/preload/turns.hpp"
#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

// The symbol has versions, of which the oldest is another kind of condition variable.
#define COHORT_NEXT_CONDITION(name) COHORT_NEXT_VERSION(name, "GLIBC_2.3.2")

int wait_on(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  COHORT_NEXT_CONDITION(pthread_cond_wait);
  return real(condition, mutex);
}

int wait_until(pthread_cond_t* condition, pthread_mutex_t* mutex, std::int64_t deadline) {
  if (deadline <= now()) {
    count_spin();
    // As the real one does: others get a chance to take the mutex.
    ::pthread_mutex_unlock(mutex);
    ::pthread_mutex_lock(mutex);
    return ETIMEDOUT;
  }
  const TimedWait wait(deadline, {.kind = Ending::Kind::broadcast, .object = condition});
  if (const int error = wait_on(condition, mutex); error != 0) return error;
  return wait.is_over() ? ETIMEDOUT : 0;
}

// A wait of a thread of the program within a library of DDS, whose limit is of the machine's clock. The limit was made
// from a duration a moment ago: whole milliseconds are taken for what was meant.
std::int64_t meant_deadline(clockid_t clock, std::int64_t limit) {
  constexpr std::int64_t millisecond = 1'000'000;
  const std::int64_t left = limit - real_time(clock);
  if (left <= 0) return now();
  return later(now(), (left + millisecond - 1) / millisecond * millisecond);
}

// Returns the deadline of a wait in virtual time, or `never` if it is one in real time.
std::int64_t deadline_of(const void* caller, clockid_t clock, const timespec& limit) {
  if (page() == nullptr) return never;
  if (overridden() != never) return overridden();
  if (is_dds(caller)) return is_thread_of_dds() ? never : meant_deadline(clock, nanoseconds(limit));
  if (is_real(caller)) return never;
  return on_page(clock, nanoseconds(limit));
}

// The clock of a condition variable's pthread_cond_timedwait, which its attributes say: bit 1 of the flags that glibc
// has in it.
clockid_t clock_of(const pthread_cond_t* condition) {
  return (condition->__data.__wrefs & 2U) != 0 ? CLOCK_MONOTONIC : CLOCK_REALTIME;
}

// The interpreter waits for its lock for 5 ms at a time, after which it asks the thread that has the lock to release
// it.
int wait_as_interpreter(const void* caller, pthread_cond_t* condition, pthread_mutex_t* mutex, bool& is_done) {
  return is_interpreter(caller) ? wait_for_interpreter(condition, mutex, is_done) : 0;
}

}  // namespace

COHORT_REPLACES int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                                           const timespec* limit) {
  COHORT_NEXT(pthread_cond_clockwait);
  const std::int64_t deadline = deadline_of(COHORT_CALLER, clock, *limit);
  if (deadline == never) return real(condition, mutex, clock, limit);
  bool is_done = false;
  if (const int result = wait_as_interpreter(COHORT_CALLER, condition, mutex, is_done); is_done) return result;
  if (page()->is_real == 0 && !is_interpreter(COHORT_CALLER)) return wait_until(condition, mutex, deadline);
  const timespec rest = in_real_time(clock, deadline);
  return real(condition, mutex, clock, &rest);
}

COHORT_REPLACES int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* limit) {
  COHORT_NEXT_CONDITION(pthread_cond_timedwait);
  const clockid_t clock = clock_of(condition);
  const std::int64_t deadline = deadline_of(COHORT_CALLER, clock, *limit);
  if (deadline == never) return real(condition, mutex, limit);
  bool is_done = false;
  if (const int result = wait_as_interpreter(COHORT_CALLER, condition, mutex, is_done); is_done) return result;
  if (page()->is_real == 0 && !is_interpreter(COHORT_CALLER)) return wait_until(condition, mutex, deadline);
  const timespec rest = in_real_time(clock, deadline);
  return real(condition, mutex, &rest);
}

COHORT_REPLACES int cnd_timedwait(cnd_t* condition, mtx_t* mutex, const timespec* limit) {
  COHORT_NEXT(cnd_timedwait);
  const std::int64_t deadline = deadline_of(COHORT_CALLER, CLOCK_REALTIME, *limit);
  if (deadline == never) return real(condition, mutex, limit);
  if (page()->is_real != 0) {
    const timespec rest = in_real_time(CLOCK_REALTIME, deadline);
    return real(condition, mutex, &rest);
  }
  const int result =
      wait_until(reinterpret_cast<pthread_cond_t*>(condition), reinterpret_cast<pthread_mutex_t*>(mutex), deadline);
  return result == 0 ? thrd_success : result == ETIMEDOUT ? thrd_timedout : thrd_error;
}

// Waits for data of DDS. Within, the library waits on condition variables; this says until when.
COHORT_REPLACES std::int32_t dds_waitset_wait(std::int32_t set, void* triggered, std::size_t size, std::int64_t time) {
  static const auto real =
      next_for<std::int32_t (*)(std::int32_t, void*, std::size_t, std::int64_t)>(COHORT_CALLER, "dds_waitset_wait");
  if (is_real(COHORT_CALLER) || time <= 0 || time == never) return real(set, triggered, size, time);
  const Override until(later(now(), time));
  return real(set, triggered, size, 365 * 24 * 3600 * second);
}

COHORT_REPLACES std::int32_t dds_waitset_wait_until(std::int32_t set, void* triggered, std::size_t size,
                                                    std::int64_t limit) {
  static const auto real = next_for<std::int32_t (*)(std::int32_t, void*, std::size_t, std::int64_t)>(
      COHORT_CALLER, "dds_waitset_wait_until");
  if (is_real(COHORT_CALLER) || limit == never) return real(set, triggered, size, limit);
  const std::int64_t deadline = on_page(CLOCK_REALTIME, limit);
  const Override until(deadline);
  return real(set, triggered, size, real_time(CLOCK_REALTIME) + 365 * 24 * 3600 * second);
}
