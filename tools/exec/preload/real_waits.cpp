// SPDX-License-Identifier: Apache-2.0

// Waits that the library does not replace: they last as long as they ask for in real time, with a warning. Limits that
// the program has computed from its own clock become such of the machine's.

#include <aio.h>
#include <netdb.h>
#include <sys/sem.h>

#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

COHORT_REPLACES int pthread_timedjoin_np(pthread_t thread, void** result, const timespec* limit) {
  COHORT_NEXT(pthread_timedjoin_np);
  if (limit == nullptr || is_real(COHORT_CALLER)) return real(thread, result, limit);
  note_real_time<"pthread_timedjoin_np">();
  const timespec rest = in_real_time(CLOCK_REALTIME, on_page(CLOCK_REALTIME, nanoseconds(*limit)));
  return real(thread, result, &rest);
}

COHORT_REPLACES int pthread_clockjoin_np(pthread_t thread, void** result, clockid_t clock, const timespec* limit) {
  COHORT_NEXT(pthread_clockjoin_np);
  if (limit == nullptr || is_real(COHORT_CALLER)) return real(thread, result, clock, limit);
  note_real_time<"pthread_clockjoin_np">();
  const timespec rest = in_real_time(clock, on_page(clock, nanoseconds(*limit)));
  return real(thread, result, clock, &rest);
}

COHORT_REPLACES int semtimedop(int set, sembuf* operations, std::size_t count, const timespec* time) noexcept {
  COHORT_NEXT(semtimedop);
  if (time != nullptr && is_virtual_for(COHORT_CALLER)) note_real_time<"semtimedop">();
  return real(set, operations, count, time);
}

COHORT_REPLACES int aio_suspend(const aiocb* const* list, int count, const timespec* time) {
  COHORT_NEXT(aio_suspend);
  if (time != nullptr && is_virtual_for(COHORT_CALLER)) note_real_time<"aio_suspend">();
  return real(list, count, time);
}

COHORT_REPLACES int aio_suspend64(const aiocb64* const* list, int count, const timespec* time) {
  COHORT_NEXT(aio_suspend64);
  if (time != nullptr && is_virtual_for(COHORT_CALLER)) note_real_time<"aio_suspend64">();
  return real(list, count, time);
}

COHORT_REPLACES int gai_suspend(const gaicb* const* list, int count, const timespec* time) {
  COHORT_NEXT(gai_suspend);
  if (time != nullptr && is_virtual_for(COHORT_CALLER)) note_real_time<"gai_suspend">();
  return real(list, count, time);
}
