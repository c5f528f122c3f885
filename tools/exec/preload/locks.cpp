// SPDX-License-Identifier: Apache-2.0

// Semaphores, mutexes and read-write locks, with a time limit.

#include <errno.h>
#include <linux/futex.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <threads.h>
#include <unistd.h>

#include "tools/exec/preload/retries.hpp"
#include "tools/exec/preload/turns.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace cohort::exec {

std::atomic<std::uint32_t> releases{0};
std::atomic<std::uint32_t> takers{0};

void note_release() {
  if (page() == nullptr) return;
  std::atomic_thread_fence(std::memory_order_seq_cst);  // between the release itself and the look at the takers
  if (takers.load(std::memory_order_relaxed) == 0) return;
  stir();
  releases.fetch_add(1);
  const auto system = next_of<"syscall", long (*)(long, ...)>();
  const int error = errno;
  system(SYS_futex, &releases, FUTEX_WAKE_PRIVATE, 0x7fffffff, nullptr, nullptr, 0);
  errno = error;
}

bool await_release(std::uint32_t seen) {
  const auto system = next_of<"syscall", long (*)(long, ...)>();
  return system(SYS_futex, &releases, FUTEX_WAIT_PRIVATE, seen, nullptr, nullptr, 0) == 0 || errno != EINTR;
}

}  // namespace cohort::exec

namespace {

// Calls `real` with a time limit of the machine's clock, so that it lasts until the given one of the virtual clock.
template <class Real, class Attempt>
int take(const void* caller, clockid_t clock, const timespec& limit, const Real& real, const Attempt& attempt) {
  if (is_real(caller) || !is_valid(limit)) return real(limit);  // which says what is wrong with the limit
  const std::int64_t deadline = on_page(clock, nanoseconds(limit));
  const int error = page()->is_real == 0 ? take_until(deadline, attempt) : is_over;
  return error != is_over ? error : real(in_real_time(clock, deadline));
}
template <class Real>
int take(const void* caller, clockid_t clock, const timespec& limit, const Real& real) {
  return take(caller, clock, limit, real, [&] { return real(past); });
}

int attempt_to_take(sem_t* semaphore) {
  if (::sem_trywait(semaphore) == 0) return 0;
  return errno == EAGAIN ? ETIMEDOUT : errno;
}

// A thread of the interpreter takes a lock of its program: at its turn, after the lock was released.
int take_at_turn(sem_t* semaphore, std::int64_t deadline) {
  for (;;) {
    if (!has_turns())
      return page()->is_real != 0 ? is_over : take_until(deadline, [=] { return attempt_to_take(semaphore); });
    PlaceInLine place(semaphore, deadline, false);
    const int error = attempt_to_take(semaphore);
    if (error != ETIMEDOUT) return error;
    if (deadline <= now()) {
      count_spin();
      return ETIMEDOUT;
    }
    if (!place.sleep()) return EINTR;
  }
}

int result_of(int error) {
  if (error == 0) return 0;
  errno = error;
  return -1;
}

template <class Real>
int take_semaphore(const void* caller, sem_t* semaphore, clockid_t clock, const timespec& limit, const Real& real) {
  if (is_interpreter(caller) && is_valid(limit)) {
    const int error = take_at_turn(semaphore, on_page(clock, nanoseconds(limit)));
    if (error != is_over) return result_of(error);
  }
  return result_of(take(
      caller, clock, limit, [&](const timespec& time) { return real(time) == 0 ? 0 : errno; },
      [&] { return attempt_to_take(semaphore); }));
}

}  // namespace

COHORT_REPLACES int sem_post(sem_t* semaphore) noexcept {
  COHORT_NEXT(sem_post);
  stir();
  const int result = real(semaphore);
  note_release();
  if (page() != nullptr) make_ready(semaphore);
  return result;
}

COHORT_REPLACES int sem_wait(sem_t* semaphore) {
  COHORT_NEXT(sem_wait);
  if (!is_interpreter(COHORT_CALLER)) return real(semaphore);
  const int error = take_at_turn(semaphore, never);
  return error == is_over ? real(semaphore) : result_of(error);
}

COHORT_REPLACES int sem_trywait(sem_t* semaphore) noexcept {
  COHORT_NEXT(sem_trywait);
  const int result = real(semaphore);
  if (is_interpreter(COHORT_CALLER) && is_virtual_for(COHORT_CALLER)) after_try_to_take(result == 0);
  return result;
}

COHORT_REPLACES int sem_timedwait(sem_t* semaphore, const timespec* limit) {
  COHORT_NEXT(sem_timedwait);
  return take_semaphore(COHORT_CALLER, semaphore, CLOCK_REALTIME, *limit,
                        [&](const timespec& time) { return real(semaphore, &time); });
}

COHORT_REPLACES int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* limit) {
  COHORT_NEXT(sem_clockwait);
  return take_semaphore(COHORT_CALLER, semaphore, clock, *limit,
                        [&](const timespec& time) { return real(semaphore, clock, &time); });
}

COHORT_REPLACES int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* limit) noexcept {
  COHORT_NEXT(pthread_mutex_timedlock);
  return take(COHORT_CALLER, CLOCK_REALTIME, *limit, [&](const timespec& time) { return real(mutex, &time); });
}

COHORT_REPLACES int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* limit) noexcept {
  COHORT_NEXT(pthread_mutex_clocklock);
  return take(COHORT_CALLER, clock, *limit, [&](const timespec& time) { return real(mutex, clock, &time); });
}

COHORT_REPLACES int mtx_timedlock(mtx_t* mutex, const timespec* limit) {
  const auto real = next_of<"pthread_mutex_timedlock", decltype(&::pthread_mutex_timedlock)>();
  auto* const inner = reinterpret_cast<pthread_mutex_t*>(mutex);  // as glibc does it
  const int error =
      take(COHORT_CALLER, CLOCK_REALTIME, *limit, [&](const timespec& time) { return real(inner, &time); });
  return error == 0 ? thrd_success : error == ETIMEDOUT ? thrd_timedout : thrd_error;
}

COHORT_REPLACES int mtx_unlock(mtx_t* mutex) {
  COHORT_NEXT(mtx_unlock);
  stir();
  const int result = real(mutex);
  note_release();
  return result;
}

COHORT_REPLACES int pthread_rwlock_timedrdlock(pthread_rwlock_t* lock, const timespec* limit) noexcept {
  COHORT_NEXT(pthread_rwlock_timedrdlock);
  return take(COHORT_CALLER, CLOCK_REALTIME, *limit, [&](const timespec& time) { return real(lock, &time); });
}

COHORT_REPLACES int pthread_rwlock_clockrdlock(pthread_rwlock_t* lock, clockid_t clock,
                                               const timespec* limit) noexcept {
  COHORT_NEXT(pthread_rwlock_clockrdlock);
  return take(COHORT_CALLER, clock, *limit, [&](const timespec& time) { return real(lock, clock, &time); });
}

COHORT_REPLACES int pthread_rwlock_timedwrlock(pthread_rwlock_t* lock, const timespec* limit) noexcept {
  COHORT_NEXT(pthread_rwlock_timedwrlock);
  return take(COHORT_CALLER, CLOCK_REALTIME, *limit, [&](const timespec& time) { return real(lock, &time); });
}

COHORT_REPLACES int pthread_rwlock_clockwrlock(pthread_rwlock_t* lock, clockid_t clock,
                                               const timespec* limit) noexcept {
  COHORT_NEXT(pthread_rwlock_clockwrlock);
  return take(COHORT_CALLER, clock, *limit, [&](const timespec& time) { return real(lock, clock, &time); });
}
