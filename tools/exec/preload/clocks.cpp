// SPDX-License-Identifier: Apache-2.0

// Clocks and sleeps.

#include <errno.h>
#include <sched.h>
#include <sys/syscall.h>
#include <sys/timeb.h>
#include <threads.h>
#include <unistd.h>

#include "tools/exec/preload/turns.hpp"
#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

std::int64_t read_clock(clockid_t clock) {
  count_spin();
  return virtual_time(clock);
}

// Returns what is left of a sleep; 0 if it was whole.
std::int64_t sleep_for(std::int64_t time) {
  const std::int64_t deadline = later(now(), time);
  if (time > 0 && !sleep_until(deadline)) return deadline > now() ? deadline - now() : 0;
  if (time <= 0) count_spin();
  return 0;
}

// Returns whether a caller sleeps in real time, and notes it.
bool sleeps_really(const void* caller) {
  if (!is_real(caller)) return false;
  note_real_sleep();
  return true;
}

int fail(int error) {
  errno = error;
  return -1;
}

}  // namespace

COHORT_REPLACES int clock_gettime(clockid_t clock, timespec* time) {
  COHORT_NEXT(clock_gettime);
  if (is_real(COHORT_CALLER) || !is_virtual(clock)) return real(clock, time);
  *time = to_timespec(read_clock(clock));
  if (clock == CLOCK_MONOTONIC && is_interpreter(COHORT_CALLER)) after_read_of_clock();
  return 0;
}

COHORT_REPLACES int gettimeofday(timeval* time, void* zone) noexcept {
  COHORT_NEXT(gettimeofday);
  if (is_real(COHORT_CALLER)) return real(time, zone);
  const std::int64_t at = read_clock(CLOCK_REALTIME);
  *time = {at / second, at % second / 1000};
  return 0;
}

COHORT_REPLACES time_t time(time_t* time) noexcept {
  COHORT_NEXT(time);
  if (is_real(COHORT_CALLER)) return real(time);
  const time_t at = read_clock(CLOCK_REALTIME) / second;
  if (time != nullptr) *time = at;
  return at;
}

COHORT_REPLACES int timespec_get(timespec* time, int base) noexcept {
  COHORT_NEXT(timespec_get);
  if (is_real(COHORT_CALLER) || base != TIME_UTC) return real(time, base);
  *time = to_timespec(read_clock(CLOCK_REALTIME));
  return base;
}

namespace {
// A library of DDS that waits for a thread of the program checks by the clock whether its time limit is over. Once it
// is, this time is later than any limit that it was given.
std::int64_t chrono_time(const void* caller, clockid_t clock) {
  if (!is_real(caller)) return read_clock(clock);
  const std::int64_t limit = overridden();
  constexpr std::int64_t ten_years = std::int64_t{10} * 365 * 24 * 3600 * second;
  return real_time(clock) + (limit != never && limit <= now() ? ten_years : 0);
}
}  // namespace

// The clocks of std::chrono, which read the system's from within the C++ library.
COHORT_REPLACES std::int64_t cohort_steady_now() __asm__("_ZNSt6chrono3_V212steady_clock3nowEv");
std::int64_t cohort_steady_now() { return chrono_time(COHORT_CALLER, CLOCK_MONOTONIC); }
COHORT_REPLACES std::int64_t cohort_system_now() __asm__("_ZNSt6chrono3_V212system_clock3nowEv");
std::int64_t cohort_system_now() { return chrono_time(COHORT_CALLER, CLOCK_REALTIME); }

COHORT_REPLACES int nanosleep(const timespec* time, timespec* left) {
  COHORT_NEXT(nanosleep);
  if (sleeps_really(COHORT_CALLER)) return real(time, left);
  if (time == nullptr) return fail(EFAULT);
  if (!is_valid(*time)) return fail(EINVAL);
  const std::int64_t rest = sleep_for(nanoseconds(*time));
  if (rest == 0) return 0;
  if (left != nullptr) *left = to_timespec(rest);
  return fail(EINTR);
}

COHORT_REPLACES int __nanosleep(const timespec*, timespec*) __attribute__((alias("nanosleep")));

COHORT_REPLACES int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
  COHORT_NEXT(clock_nanosleep);
  if (!is_virtual(clock) || sleeps_really(COHORT_CALLER)) return real(clock, flags, time, left);
  if (!is_valid(*time)) return EINVAL;
  if ((flags & TIMER_ABSTIME) != 0) {
    const std::int64_t deadline = on_page(clock, nanoseconds(*time));
    if (deadline <= now()) count_spin();
    return sleep_until(deadline) ? 0 : EINTR;
  }
  const std::int64_t rest = sleep_for(nanoseconds(*time));
  if (rest == 0) return 0;
  if (left != nullptr) *left = to_timespec(rest);
  return EINTR;
}

COHORT_REPLACES int usleep(useconds_t time) {
  COHORT_NEXT(usleep);
  if (sleeps_really(COHORT_CALLER)) return real(time);
  return sleep_for(std::int64_t{time} * 1000) == 0 ? 0 : fail(EINTR);
}

COHORT_REPLACES unsigned sleep(unsigned time) {
  COHORT_NEXT(sleep);
  if (sleeps_really(COHORT_CALLER)) return real(time);
  return static_cast<unsigned>((sleep_for(std::int64_t{time} * second) + second - 1) / second);
}

COHORT_REPLACES int thrd_sleep(const timespec* time, timespec* left) {
  COHORT_NEXT(thrd_sleep);
  if (sleeps_really(COHORT_CALLER)) return real(time, left);
  const std::int64_t rest = sleep_for(nanoseconds(*time));
  if (rest == 0) return 0;
  if (left != nullptr) *left = to_timespec(rest);
  return -1;
}

COHORT_REPLACES int sched_yield() noexcept {
  COHORT_NEXT(sched_yield);
  if (!is_real(COHORT_CALLER)) count_spin();
  return real();
}

// Cyclone DDS calls these itself too.
COHORT_REPLACES std::int64_t dds_time() {
  return is_real(COHORT_CALLER) ? real_time(CLOCK_REALTIME) : read_clock(CLOCK_REALTIME);
}
COHORT_REPLACES void dds_sleepfor(std::int64_t time) {
  if (!sleeps_really(COHORT_CALLER)) return void(sleep_for(time));
  // As Cyclone DDS does it. Its own function cannot be found where a program has loaded DDS for itself alone, as Python
  // does.
  COHORT_NEXT(nanosleep);
  timespec rest = to_timespec(time > 0 ? time : 0);
  while (real(&rest, &rest) != 0 && errno == EINTR) {
  }
}
