// Waits of threads for each other, with a time limit: condition variables, semaphores, futexes; and waits for data of
// DDS.

#include <errno.h>
#include <linux/futex.h>
#include <semaphore.h>
#include <stdarg.h>
#include <sys/syscall.h>
#include <threads.h>
#include <unistd.h>

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
  if (is_real(caller) || is_interpreter(caller)) return never;
  return on_page(clock, nanoseconds(limit));
}

// After the end of virtual time.
timespec in_real_time(clockid_t clock, std::int64_t deadline) {
  return to_timespec(real_time(clock) + deadline - now());
}

// The clock of a condition variable's pthread_cond_timedwait, which its attributes say: bit 1 of the flags that glibc
// has in it.
clockid_t clock_of(const pthread_cond_t* condition) {
  return (condition->__data.__wrefs & 2U) != 0 ? CLOCK_MONOTONIC : CLOCK_REALTIME;
}

}  // namespace

COHORT_REPLACES int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                                           const timespec* limit) {
  COHORT_NEXT(pthread_cond_clockwait);
  const std::int64_t deadline = deadline_of(COHORT_CALLER, clock, *limit);
  if (deadline == never) return real(condition, mutex, clock, limit);
  if (page()->is_real == 0) return wait_until(condition, mutex, deadline);
  const timespec rest = in_real_time(clock, deadline);
  return real(condition, mutex, clock, &rest);
}

COHORT_REPLACES int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* limit) {
  COHORT_NEXT_CONDITION(pthread_cond_timedwait);
  const clockid_t clock = clock_of(condition);
  const std::int64_t deadline = deadline_of(COHORT_CALLER, clock, *limit);
  if (deadline == never) return real(condition, mutex, limit);
  if (page()->is_real == 0) return wait_until(condition, mutex, deadline);
  const timespec rest = in_real_time(clock, deadline);
  return real(condition, mutex, &rest);
}

COHORT_REPLACES int cnd_timedwait(cnd_t* condition, mtx_t* mutex, const timespec* limit) {
  COHORT_NEXT(cnd_timedwait);
  if (is_real(COHORT_CALLER)) return real(condition, mutex, limit);
  const int result = pthread_cond_clockwait(reinterpret_cast<pthread_cond_t*>(condition),
                                            reinterpret_cast<pthread_mutex_t*>(mutex), CLOCK_REALTIME, limit);
  return result == 0 ? thrd_success : result == ETIMEDOUT ? thrd_timedout : thrd_error;
}

namespace {

// Those who wait for a semaphore: a thread that posts one wakes them to try again.
std::atomic<std::uint32_t> posts{0};
std::atomic<std::uint32_t> takers{0};

long wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen) {
  const auto real = next_of<"syscall", long (*)(long, ...)>();
  return real(SYS_futex, &word, FUTEX_WAIT_PRIVATE, seen, nullptr, nullptr, 0);
}

int take_until(sem_t* semaphore, std::int64_t deadline) {
  for (;;) {
    const std::uint32_t seen = posts;
    if (::sem_trywait(semaphore) == 0) return 0;
    if (errno != EAGAIN && errno != EINTR) return -1;
    if (deadline <= now()) {
      count_spin();
      errno = ETIMEDOUT;
      return -1;
    }
    takers.fetch_add(1);
    {
      const TimedWait wait(deadline, {.kind = Ending::Kind::wake_futex, .object = &posts});
      while (!wait.is_over() && posts == seen && page()->is_real == 0)
        if (wait_for_change(posts, seen) != 0 && errno == EINTR) {
          takers.fetch_sub(1);
          return -1;
        }
    }
    takers.fetch_sub(1);
  }
}

int take_semaphore(const void* caller, sem_t* semaphore, clockid_t clock, const timespec* limit, bool& is_done) {
  is_done = false;
  if (is_real(caller)) return 0;
  if (!is_valid(*limit)) return 0;  // which the real one says
  if (page()->is_real != 0) return 0;
  is_done = true;
  return take_until(semaphore, on_page(clock, nanoseconds(*limit)));
}

}  // namespace

COHORT_REPLACES int sem_post(sem_t* semaphore) noexcept {
  COHORT_NEXT(sem_post);
  const int result = real(semaphore);
  if (page() == nullptr) return result;
  stir();
  posts.fetch_add(1);
  const auto system = next_of<"syscall", long (*)(long, ...)>();
  if (takers != 0) system(SYS_futex, &posts, FUTEX_WAKE_PRIVATE, 0x7fffffff, nullptr, nullptr, 0);
  return result;
}

COHORT_REPLACES int sem_timedwait(sem_t* semaphore, const timespec* limit) {
  COHORT_NEXT(sem_timedwait);
  bool is_done = false;
  const int result = take_semaphore(COHORT_CALLER, semaphore, CLOCK_REALTIME, limit, is_done);
  if (is_done) return result;
  if (is_real(COHORT_CALLER)) return real(semaphore, limit);
  const timespec rest = in_real_time(CLOCK_REALTIME, on_page(CLOCK_REALTIME, nanoseconds(*limit)));
  return real(semaphore, &rest);
}

COHORT_REPLACES int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* limit) {
  COHORT_NEXT(sem_clockwait);
  bool is_done = false;
  const int result = take_semaphore(COHORT_CALLER, semaphore, clock, limit, is_done);
  if (is_done) return result;
  if (is_real(COHORT_CALLER)) return real(semaphore, clock, limit);
  const timespec rest = in_real_time(clock, on_page(clock, nanoseconds(*limit)));
  return real(semaphore, clock, &rest);
}

// Waits on futexes, by which the C++ library waits for futures.
COHORT_REPLACES long syscall(long number, ...) noexcept {
  const auto real = next_of<"syscall", long (*)(long, ...)>();
  va_list list;
  va_start(list, number);
  long a[6];
  for (long& each : a) each = va_arg(list, long);
  va_end(list);
  const void* const caller = COHORT_CALLER;
  const auto go_on = [&] { return real(number, a[0], a[1], a[2], a[3], a[4], a[5]); };
  stir();
  if (is_real(caller)) return go_on();
  const auto* const time = [&]() -> const timespec* {
    switch (number) {
      case SYS_futex: return reinterpret_cast<const timespec*>(a[3]);
      default: return nullptr;
    }
  }();
  if (number == SYS_clock_gettime && is_virtual(static_cast<clockid_t>(a[0]))) {
    count_spin();
    *reinterpret_cast<timespec*>(a[1]) = to_timespec(virtual_time(static_cast<clockid_t>(a[0])));
    return 0;
  }
  if (number == SYS_nanosleep)
    return nanosleep(reinterpret_cast<const timespec*>(a[0]), reinterpret_cast<timespec*>(a[1]));
  if (number == SYS_clock_nanosleep) {
    const int error = clock_nanosleep(static_cast<clockid_t>(a[0]), static_cast<int>(a[1]),
                                      reinterpret_cast<const timespec*>(a[2]), reinterpret_cast<timespec*>(a[3]));
    if (error == 0) return 0;
    errno = error;
    return -1;
  }
  const int operation = static_cast<int>(a[1]) & FUTEX_CMD_MASK;
  const bool is_wait = operation == FUTEX_WAIT || operation == FUTEX_WAIT_BITSET;
  if (number != SYS_futex || !is_wait || time == nullptr || page()->is_real != 0) return go_on();
  const bool is_absolute = operation == FUTEX_WAIT_BITSET;
  const clockid_t clock = (a[1] & FUTEX_CLOCK_REALTIME) != 0 ? CLOCK_REALTIME : CLOCK_MONOTONIC;
  const std::int64_t deadline = is_absolute ? on_page(clock, nanoseconds(*time)) : later(now(), nanoseconds(*time));
  const auto time_out = [] {
    errno = ETIMEDOUT;
    return -1L;
  };
  if (deadline <= now()) {
    count_spin();
    return time_out();
  }
  const TimedWait wait(deadline, {.kind = Ending::Kind::wake_futex, .object = reinterpret_cast<void*>(a[0])});
  const long result = real(number, a[0], a[1], a[2], nullptr, a[4], a[5]);
  return result == 0 && wait.is_over() ? time_out() : result;
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
