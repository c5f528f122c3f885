// SPDX-License-Identifier: Apache-2.0

// System calls that a program makes itself.

#include <errno.h>
#include <linux/futex.h>
#include <stdarg.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

bool waits_by_real_time(long number) {
  switch (number) {
    case SYS_ppoll:
    case SYS_pselect6:
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
    case SYS_rt_sigtimedwait:
    case SYS_mq_timedsend:
    case SYS_mq_timedreceive:
    case SYS_semtimedop:
    case SYS_recvmmsg:
    case SYS_io_getevents:
    case SYS_io_pgetevents:
    case SYS_timer_settime:
    case SYS_timerfd_settime:
    case SYS_setitimer:
#ifdef SYS_futex_waitv
    case SYS_futex_waitv:
#endif
#ifdef SYS_poll  // which not every architecture has
    case SYS_poll:
    case SYS_select:
    case SYS_epoll_wait:
    case SYS_alarm:
#endif
      return true;
    default: return false;
  }
}

}  // namespace

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
  if (page()->is_real == 0 && waits_by_real_time(number)) note_real_time<"syscall">();
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
