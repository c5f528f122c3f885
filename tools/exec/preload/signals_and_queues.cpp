// SPDX-License-Identifier: Apache-2.0

// Waits with a time limit for signals, and for message queues.

#include <errno.h>
#include <mqueue.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

// Repeats an attempt until it succeeds, each time that the descriptor is ready. `busy`: the error that it gives if it
// is not.
template <class Attempt>
auto attempt_until(std::int64_t deadline, int descriptor, short events, int busy, const Attempt& attempt) {
  for (;;) {
    const auto result = attempt();
    if (result >= 0 || errno != busy) return result;
    pollfd polled{descriptor, events, 0};
    const int ready = poll_until(&polled, 1, deadline, nullptr);
    if (ready < 0) return decltype(result){-1};
    if (ready > 0) continue;
    errno = busy;
    return decltype(result){-1};
  }
}

// Takes a message from a queue or adds one, until a limit of the calendar clock. `real`: with a limit.
template <class Real>
auto use_queue(const void* caller, mqd_t queue, short events, const timespec* limit, const Real& real) {
  if (limit == nullptr || is_real(caller) || !is_valid(*limit)) return real(limit);
  const std::int64_t deadline = on_page(CLOCK_REALTIME, nanoseconds(*limit));
  if (page()->is_real != 0) {
    const timespec rest = in_real_time(CLOCK_REALTIME, deadline);
    return real(&rest);
  }
  return attempt_until(deadline, queue, events, ETIMEDOUT, [&] { return real(&past); });
}

}  // namespace

COHORT_REPLACES int sigtimedwait(const sigset_t* set, siginfo_t* info, const timespec* time) {
  COHORT_NEXT(sigtimedwait);
  if (time == nullptr || !is_virtual_for(COHORT_CALLER) || !is_valid(*time)) return real(set, info, time);
  const std::int64_t deadline = later(now(), nanoseconds(*time));
  const int signals = ::signalfd(-1, set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signals < 0) return -1;
  const int result = attempt_until(deadline, signals, POLLIN, EAGAIN, [&] { return real(set, info, &past); });
  const int error = errno;
  ::close(signals);
  errno = error;
  return result;
}

COHORT_REPLACES ssize_t mq_timedreceive(mqd_t queue, char* bytes, std::size_t size, unsigned* priority,
                                        const timespec* limit) {
  COHORT_NEXT(mq_timedreceive);
  return use_queue(COHORT_CALLER, queue, POLLIN, limit,
                   [&](const timespec* time) { return real(queue, bytes, size, priority, time); });
}

COHORT_REPLACES int mq_timedsend(mqd_t queue, const char* bytes, std::size_t size, unsigned priority,
                                 const timespec* limit) {
  COHORT_NEXT(mq_timedsend);
  stir();
  return use_queue(COHORT_CALLER, queue, POLLOUT, limit,
                   [&](const timespec* time) { return real(queue, bytes, size, priority, time); });
}
