// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

/// The memory that `cohort exec` shares with the programs that it runs in virtual time. In the programs, the library
/// `preload/` accesses it; this library replaces the calls that read clocks and wait. Times are in nanoseconds.
namespace cohort::exec {

inline constexpr std::uint32_t page_version = 4;
inline constexpr const char* page_variable = "COHORT_EXEC_PAGE";  ///< environment variable with the page's file
inline constexpr std::size_t most_processes = 256;
inline constexpr std::size_t most_real_sleepers = 256;
inline constexpr std::size_t most_waits = 2048;
inline constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

/// Number of times in a row that a thread may read the clock, or poll without success, without waiting. After that the
/// thread counts as spinning, and waits for `spin_quantum`, so that virtual time advances.
inline constexpr std::uint32_t reads_before_it_spins = 1000;
inline constexpr std::int64_t spin_quantum = 100'000;

/// The mechanism that ends a wait.
enum class WaitKind : std::uint32_t {
  none,    ///< free
  sleep,   ///< a thread sleeps on `wake`
  helper,  ///< the process's helper thread ends it: a poll, a condition variable, a semaphore, a timer
  turn,    ///< a thread of the Python interpreter sleeps on `wake` until `is_ready` and all threads are at rest
};

/// An event of a process at a virtual time: the end of a thread's wait, or a timer.
struct Wait {
  std::atomic<std::int32_t> process{0};  ///< 0: free
  std::atomic<std::int32_t> thread{0};   ///< 0: a timer
  std::atomic<std::uint64_t> order{0};   ///< among waits that end at the same time, the lower first
  std::atomic<std::int64_t> deadline{never};
  std::atomic<WaitKind> kind{WaitKind::none};
  std::atomic<std::uint32_t> wake{0};        ///< futex: 1 once its end was announced
  std::atomic<const void*> object{nullptr};  ///< address of the awaited object in its process
  std::atomic<std::uint32_t> is_ready{0};    ///< nonzero once the object may be free
};

struct Process {
  std::atomic<std::int32_t> id{0};            ///< 0: free
  std::atomic<std::uint32_t> attention{0};    ///< futex of its helper thread
  std::atomic<std::uint32_t> has_started{0};  ///< the process has loaded the library
  std::atomic<std::int32_t> turn{0};          ///< thread whose wait was ended last, which may run Python; 0: any
  std::atomic<std::uint64_t> real_calls{0};   ///< bits: calls made that wait in real time
};

struct ClockPage {
  std::atomic<std::uint32_t> version{page_version};
  std::atomic<std::uint32_t> is_real{0};     ///< nonzero: the clocks run in real time, from `now` at `real_from`
  std::atomic<std::int64_t> real_from{0};    ///< CLOCK_MONOTONIC
  std::atomic<std::int64_t> now{0};          ///< CLOCK_MONOTONIC and similar clocks of the program
  std::atomic<std::int64_t> date{0};         ///< CLOCK_REALTIME of the program when `now` is 0
  std::atomic<std::uint32_t> changes{0};     ///< futex: changed when a thread begins to wait
  std::atomic<std::uint32_t> host_waits{0};  ///< nonzero while a thread waits on `changes`
  std::atomic<std::uint32_t> host_looks{0};  ///< nonzero while the host checks whether all threads wait
  std::atomic<std::uint32_t> ready{0};       ///< futex: changed when a thread becomes ready, outside a check
  std::atomic<std::uint32_t> threads{0};     ///< changed when threads or processes are added
  std::atomic<std::uint32_t> no_turns{0};    ///< nonzero: Python threads do not wait for turns
  std::atomic<std::uint32_t> real_calls{0};  ///< changed when a process makes another call that waits in real time
  std::atomic<std::uint32_t> ros_nodes{0};   ///< number of ROS 2 nodes
  // If a thread's wait was ended while all others wait, the thread may end its next waits itself, until it does
  // something that may wake another thread.
  std::atomic<std::int32_t> alone{0};         ///< the thread; 0: none
  std::atomic<std::int64_t> alone_until{0};   ///< latest time to which it may set the clock
  std::atomic<std::uint64_t> alone_since{0};  ///< `stirs` at the beginning
  std::atomic<std::uint64_t> stirs{0};        ///< number of actions that may wake another thread
  std::atomic<std::uint64_t> next_order{0};
  std::atomic<std::uint32_t> waits_used{0};
  std::array<Process, most_processes> processes{};
  /// Threads that have slept in real time through a replaced call, as DDS threads do; 0: free.
  std::array<std::atomic<std::int32_t>, most_real_sleepers> real_sleepers{};
  std::array<Wait, most_waits> waits{};
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<WaitKind>::is_always_lock_free);

}  // namespace cohort::exec
