// SPDX-License-Identifier: Apache-2.0

// Waits for descriptors, with a time limit.

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <unistd.h>

#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

constexpr std::int64_t millisecond = 1'000'000;

int poll_really(pollfd* polled, nfds_t count, const timespec* time, const sigset_t* mask) {
  COHORT_NEXT(ppoll);
  return real(polled, count, time, mask);
}

}  // namespace

int cohort::exec::poll_until(pollfd* polled, nfds_t count, std::int64_t deadline, const sigset_t* mask) {
  constexpr timespec at_once{};
  const int ready = poll_really(polled, count, &at_once, mask);
  if (ready != 0) return ready;
  if (deadline <= now()) {
    count_spin();
    return 0;
  }
  constexpr nfds_t most_on_stack = 64;
  pollfd few[most_on_stack + 1];
  pollfd* const all =
      count <= most_on_stack ? few : static_cast<pollfd*>(__builtin_alloca((count + 1) * sizeof(pollfd)));
  if (count > 0) ::memcpy(all, polled, count * sizeof(pollfd));
  const int event = event_of_thread();
  all[count] = {event, POLLIN, 0};
  const TimedWait wait(deadline, {.kind = Ending::Kind::write_event, .descriptor = event});
  const int result = poll_really(all, count + 1, nullptr, mask);
  if (result < 0) return result;
  if (count > 0) ::memcpy(polled, all, count * sizeof(pollfd));
  return result - (all[count].revents != 0 ? 1 : 0);
}

namespace {

int poll_for(const void* caller, pollfd* polled, nfds_t count, int time) {
  COHORT_NEXT(poll);
  if (time < 0 || !is_virtual_for(caller)) return real(polled, count, time);
  return poll_until(polled, count, time == 0 ? 0 : later(now(), time * millisecond), nullptr);
}

int ppoll_for(const void* caller, pollfd* polled, nfds_t count, const timespec* time, const sigset_t* mask) {
  if (time == nullptr || !is_virtual_for(caller)) return poll_really(polled, count, time, mask);
  return poll_until(polled, count, nanoseconds(*time) == 0 ? 0 : later(now(), nanoseconds(*time)), mask);
}

}  // namespace

COHORT_REPLACES int poll(pollfd* polled, nfds_t count, int time) {
  return poll_for(COHORT_CALLER, polled, count, time);
}
COHORT_REPLACES int __poll(pollfd*, nfds_t, int) __attribute__((alias("poll")));

COHORT_REPLACES int ppoll(pollfd* polled, nfds_t count, const timespec* time, const sigset_t* mask) {
  return ppoll_for(COHORT_CALLER, polled, count, time, mask);
}

// Calls of programs that were compiled with _FORTIFY_SOURCE. If the array is too small, the C library ends the program.
COHORT_REPLACES int __poll_chk(pollfd* polled, nfds_t count, int time, std::size_t size) {
  const auto real = next_of<"__poll_chk", int (*)(pollfd*, nfds_t, int, std::size_t)>();
  if (size / sizeof *polled < count) return real(polled, count, time, size);
  return poll_for(COHORT_CALLER, polled, count, time);
}
COHORT_REPLACES int __ppoll_chk(pollfd* polled, nfds_t count, const timespec* time, const sigset_t* mask,
                                std::size_t size) {
  const auto real = next_of<"__ppoll_chk", int (*)(pollfd*, nfds_t, const timespec*, const sigset_t*, std::size_t)>();
  if (size / sizeof *polled < count) return real(polled, count, time, mask, size);
  return ppoll_for(COHORT_CALLER, polled, count, time, mask);
}

namespace {

// As poll_until does.
int select_until(int count, fd_set* reads, fd_set* writes, fd_set* others, std::int64_t deadline,
                 const sigset_t* mask) {
  COHORT_NEXT(pselect);
  constexpr timespec at_once{};
  fd_set* const given[3] = {reads, writes, others};
  fd_set wanted[3];
  for (int i = 0; i < 3; ++i)
    if (given[i] != nullptr) wanted[i] = *given[i];
  const int ready = real(count, reads, writes, others, &at_once, mask);
  if (ready != 0) return ready;
  if (deadline <= now()) {
    count_spin();
    return 0;
  }
  const int event = event_of_thread();
  if (event >= FD_SETSIZE) {
    errno = EMFILE;
    return -1;
  }
  if (reads == nullptr) FD_ZERO(&wanted[0]);
  FD_SET(event, &wanted[0]);
  const TimedWait wait(deadline, {.kind = Ending::Kind::write_event, .descriptor = event});
  const int result = real(event >= count ? event + 1 : count, &wanted[0], writes != nullptr ? &wanted[1] : nullptr,
                          others != nullptr ? &wanted[2] : nullptr, nullptr, mask);
  if (result < 0) return result;
  const bool is_late = FD_ISSET(event, &wanted[0]);
  FD_CLR(event, &wanted[0]);
  for (int i = 0; i < 3; ++i)
    if (given[i] != nullptr) *given[i] = wanted[i];
  return result - (is_late ? 1 : 0);
}

}  // namespace

COHORT_REPLACES int select(int count, fd_set* reads, fd_set* writes, fd_set* others, timeval* time) {
  COHORT_NEXT(select);
  if (time == nullptr || !is_virtual_for(COHORT_CALLER)) return real(count, reads, writes, others, time);
  const std::int64_t limit = nanoseconds(*time);
  const std::int64_t deadline = later(now(), limit);
  const int result = select_until(count, reads, writes, others, limit == 0 ? 0 : deadline, nullptr);
  const std::int64_t left = deadline > now() ? deadline - now() : 0;  // as Linux does
  *time = {left / second, left % second / 1000};
  return result;
}

COHORT_REPLACES int __select(int, fd_set*, fd_set*, fd_set*, timeval*) __attribute__((alias("select")));

COHORT_REPLACES int pselect(int count, fd_set* reads, fd_set* writes, fd_set* others, const timespec* time,
                            const sigset_t* mask) {
  COHORT_NEXT(pselect);
  if (time == nullptr || !is_virtual_for(COHORT_CALLER)) return real(count, reads, writes, others, time, mask);
  return select_until(count, reads, writes, others, nanoseconds(*time) == 0 ? 0 : later(now(), nanoseconds(*time)),
                      mask);
}

namespace {

int take_events(int queue, epoll_event* events, int most) {
  COHORT_NEXT(epoll_wait);
  return real(queue, events, most, 0);
}

int wait_for_events(int queue, epoll_event* events, int most, std::int64_t deadline, const sigset_t* mask) {
  for (;;) {
    pollfd polled{queue, POLLIN, 0};
    const int ready = poll_until(&polled, 1, deadline, mask);
    if (ready <= 0) return ready;
    const int count = take_events(queue, events, most);
    if (count != 0) return count;  // else another thread took them
  }
}

}  // namespace

COHORT_REPLACES int epoll_wait(int queue, epoll_event* events, int most, int time) {
  COHORT_NEXT(epoll_wait);
  if (time < 0 || !is_virtual_for(COHORT_CALLER)) return real(queue, events, most, time);
  return wait_for_events(queue, events, most, time == 0 ? 0 : later(now(), time * millisecond), nullptr);
}

COHORT_REPLACES int epoll_pwait(int queue, epoll_event* events, int most, int time, const sigset_t* mask) {
  COHORT_NEXT(epoll_pwait);
  if (time < 0 || !is_virtual_for(COHORT_CALLER)) return real(queue, events, most, time, mask);
  return wait_for_events(queue, events, most, time == 0 ? 0 : later(now(), time * millisecond), mask);
}

COHORT_REPLACES int epoll_pwait2(int queue, epoll_event* events, int most, const timespec* time, const sigset_t* mask) {
  COHORT_NEXT(epoll_pwait2);
  if (time == nullptr || !is_virtual_for(COHORT_CALLER)) return real(queue, events, most, time, mask);
  return wait_for_events(queue, events, most, nanoseconds(*time) == 0 ? 0 : later(now(), nanoseconds(*time)), mask);
}
