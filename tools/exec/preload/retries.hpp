// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <errno.h>

#include "tools/exec/preload/virtual_clock.hpp"

/// Takes semaphores and locks with a time limit. A thread tries again whenever any of them is released.
namespace cohort::exec {

extern std::atomic<std::uint32_t> releases;  // futex
extern std::atomic<std::uint32_t> takers;    // threads that wait for a release

/// Wakes the threads that wait for a release.
void note_release();
/// Waits until `releases` differs from `seen`. Returns false if a signal handler has run.
bool await_release(std::uint32_t seen);

/// A result of take_until: virtual time has ended during the wait.
inline constexpr int is_over = -1;

/// Tries to take an object until a virtual time. `attempt` returns 0, ETIMEDOUT if the object is not free, or another
/// error. Returns the last result of `attempt`, EINTR, or `is_over`.
template <class Attempt>
int take_until(std::int64_t deadline, const Attempt& attempt) {
  for (;;) {
    takers.fetch_add(1);
    const std::uint32_t seen = releases;
    const int error = attempt();
    const bool waits = error == ETIMEDOUT && deadline > now();
    bool is_interrupted = false;
    if (waits) {
      const TimedWait wait(deadline, {.kind = Ending::Kind::wake_futex, .object = &releases});
      while (!is_interrupted && !wait.is_over() && releases == seen && page()->is_real == 0)
        is_interrupted = !await_release(seen);
    }
    takers.fetch_sub(1);
    if (error == ETIMEDOUT && !waits) count_spin();
    if (!waits) return error;
    if (is_interrupted) return EINTR;
    if (page()->is_real != 0) return is_over;
  }
}

}  // namespace cohort::exec
