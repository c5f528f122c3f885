// SPDX-License-Identifier: Apache-2.0

// A preloaded library that sets the time of day back by a minute.

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

int clock_gettime(clockid_t clock, struct timespec* time) {
  const long result = syscall(SYS_clock_gettime, clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec -= 60;
  return (int)result;
}
